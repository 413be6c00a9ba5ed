// Expressions as text, in the form in which echo prints function literals.
#include <algorithm>

#include "front/scad/text/syntax.h"

namespace kerf::scad {
std::string_view sign_of(ExprKind kind) {
  switch (kind) {
    case ExprKind::multiply: return "*";
    case ExprKind::divide: return "/";
    case ExprKind::modulo: return "%";
    case ExprKind::power: return "^";
    case ExprKind::add: return "+";
    case ExprKind::subtract: return "-";
    case ExprKind::less: return "<";
    case ExprKind::less_equal: return "<=";
    case ExprKind::greater: return ">";
    case ExprKind::greater_equal: return ">=";
    case ExprKind::equal: return "==";
    case ExprKind::not_equal: return "!=";
    case ExprKind::both: return "&&";
    case ExprKind::either: return "||";
    default: return "";
  }
}

namespace {

void append(std::string& out, const Expr& e);

void append_escaped(std::string& out, const std::string& text) {
  out += '"';
  for (const char c : text) {
    switch (c) {
      case '\n': out += "\\n"; break;
      case '\t': out += "\\t"; break;
      case '\r': out += "\\r"; break;
      case '"': out += "\\\""; break;
      case '\\': out += "\\\\"; break;
      default: out += c;
    }
  }
  out += '"';
}

void append(std::string& out, const std::vector<Argument>& list) {
  bool first = true;
  for (const Argument& a : list) {
    if (!first) out += ", ";
    first = false;
    if (!a.name.empty()) out += a.name + (a.value != nullptr ? " = " : "");
    if (a.value != nullptr) append(out, *a.value);
  }
}

void append_binary(std::string& out, const Expr& e, std::string_view sign) {
  out += '(';
  append(out, *e.a);
  out += ' ';
  out += sign;
  out += ' ';
  append(out, *e.b);
  out += ')';
}

void append_call(std::string& out, const CallExpr& e) {
  const bool is_name = e.a == nullptr || e.a->kind == ExprKind::special;
  if (!is_name) out += '(';
  if (e.a != nullptr)
    append(out, *e.a);
  else
    out += e.name;
  if (!is_name) out += ')';
  out += '(';
  append(out, e.arguments);
  out += ')';
}

void append_vector(std::string& out, const VectorExpr& e) {
  out += '[';
  bool first = true;
  for (const Expr* item : e.items) {
    if (!first) out += ", ";
    first = false;
    append(out, *item);
  }
  out += ']';
}

void append_bind(std::string& out, const BindExpr& e, std::string_view word) {
  out += word;
  out += '(';
  append(out, e.arguments);
  if (e.kind == ExprKind::c_loop) {
    out += ';';
    append(out, *e.b);
    out += ';';
    append(out, e.steps);
  }
  out += ')';
  if (e.a == nullptr) return;
  out += ' ';
  append(out, *e.a);
}

/// A loop over several variables is printed as loops in each other.
void append_loops(std::string& out, const BindExpr& e) {
  for (const Argument& a : e.arguments) {
    out += (&a == e.arguments.data() ? "for(" : "(for(") + a.name + " = ";
    append(out, *a.value);
    out += ") ";
  }
  out += '(';
  append(out, *e.a);
  out += std::string(std::max<std::size_t>(e.arguments.size(), 1), ')');
}

void append_range(std::string& out, const Expr& e) {
  out += '[';
  append(out, *e.a);
  if (e.b != nullptr) {
    out += " : ";
    append(out, *e.b);
  }
  out += " : ";
  append(out, *e.c);
  out += ']';
}

void append_choice(std::string& out, const Expr& e) {
  out += '(';
  append(out, *e.a);
  out += " ? ";
  append(out, *e.b);
  out += " : ";
  append(out, *e.c);
  out += ')';
}

void append_filter(std::string& out, const Expr& e) {
  out += "if(";
  append(out, *e.a);
  out += ") (";
  append(out, *e.b);
  out += ')';
  if (e.c == nullptr) return;
  out += " else (";
  append(out, *e.c);
  out += ')';
}

void append_sign(std::string& out, const Expr& e, char sign) {
  out += sign;
  append(out, *e.a);
}

void append(std::string& out, const Expr& e) {
  switch (e.kind) {
    case ExprKind::constant: {
      const Value& v = static_cast<const Constant&>(e).value;
      if (v.is(Type::string))
        append_escaped(out, v.text());
      else
        out += to_string(v);
      return;
    }
    case ExprKind::local:
    case ExprKind::variable: out += static_cast<const Variable&>(e).name; return;
    case ExprKind::special: out += static_cast<const Special&>(e).name; return;
    case ExprKind::negative: append_sign(out, e, '-'); return;
    case ExprKind::positive: append(out, *e.a); return;
    case ExprKind::negation: append_sign(out, e, '!'); return;
    case ExprKind::choice: append_choice(out, e); return;
    case ExprKind::index:
      append(out, *e.a);
      out += '[';
      append(out, *e.b);
      out += ']';
      return;
    case ExprKind::member:
      append(out, *e.a);
      out += '.' + static_cast<const Member&>(e).name;
      return;
    case ExprKind::call: append_call(out, static_cast<const CallExpr&>(e)); return;
    case ExprKind::vector: append_vector(out, static_cast<const VectorExpr&>(e)); return;
    case ExprKind::range: append_range(out, e); return;
    case ExprKind::let: append_bind(out, static_cast<const BindExpr&>(e), "let"); return;
    case ExprKind::check: append_bind(out, static_cast<const BindExpr&>(e), "assert"); return;
    case ExprKind::print: append_bind(out, static_cast<const BindExpr&>(e), "echo"); return;
    case ExprKind::loop: append_loops(out, static_cast<const BindExpr&>(e)); return;
    case ExprKind::c_loop: append_bind(out, static_cast<const BindExpr&>(e), "for"); return;
    case ExprKind::literal: out += text_of(static_cast<const FunctionLiteral&>(e).function); return;
    case ExprKind::each:
      out += "each (";
      append(out, *e.a);
      out += ')';
      return;
    case ExprKind::filter: append_filter(out, e); return;
    default: append_binary(out, e, sign_of(e.kind)); return;
  }
}

}  // namespace

std::string text_of(const Expr& expr) {
  std::string out;
  append(out, expr);
  return out;
}

std::string text_of(const Function& literal) {
  std::string out = "function(";
  bool first = true;
  for (const Parameter& p : literal.parameters) {
    if (!first) out += ", ";
    first = false;
    out += p.name;
    if (p.standard != nullptr) out += " = " + text_of(*p.standard);
  }
  return out + ") " + text_of(*literal.body);
}

}  // namespace kerf::scad
