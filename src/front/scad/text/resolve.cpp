// One walk over the tree with the scopes around each node.
//
// A frame is an array of values: of a file, of a block with variables, of a call. Variables of let and of
// loops in vectors have slots in the frame around them, unless a function literal may keep them beyond it.
#include "front/scad/text/resolve.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>

#include "base/codes/scad.h"
#include "front/scad/text/argument_order.h"

namespace kerf::scad {
namespace {

struct Frame {
  std::uint32_t slots = 0;
};

/// Names that are visible from here on.
struct Scope {
  const Scope* outer = nullptr;
  Frame* frame = nullptr;  // in which its variables are
  bool starts_frame = false;
  const Body* block = nullptr;  // of a block: its functions and modules
  const Unit* unit = nullptr;   // of the outermost block of a file
  bool may_be_unset = false;    // variables of blocks, before their assignment
  std::unordered_map<std::string, std::uint32_t> variables = {};
};

class Resolver {
 public:
  Resolver(Program& program, const KnownNames& known, Diagnostics& diagnostics)
      : program_(program), known_(known), diagnostics_(diagnostics) {}

  void run() {
    Frame root_frame{1};
    Scope root{.frame = &root_frame, .starts_frame = true, .may_be_unset = true};
    root.variables["PI"] = kPiSlot;
    add_undeclared();
    for (const auto& e : program_.expressions) {
      has_prints_ = has_prints_ || e->kind == ExprKind::print;
      has_specials_ = has_specials_ || e->kind == ExprKind::special;
    }
    for (const auto& unit : program_.units) {
      unit->block->own_frame = true;
      block(*unit->block, &root, unit.get());
    }
  }

 private:
  /// As in OpenSCAD, an argument with a name that is no parameter is a variable of the called function or
  /// module: a parameter that is appended here.
  void add_undeclared() {
    std::unordered_map<std::string, std::set<std::string>> named;
    const auto note = [&](const std::string& called, const std::vector<Argument>& arguments) {
      for (const Argument& a : arguments)
        if (!a.name.empty() && !a.special) named[called].insert(a.name);
    };
    for (const auto& s : program_.statements)
      if (s->kind == StatementKind::call && s->object == nullptr) note(s->name, s->arguments);
    for (const auto& e : program_.expressions)
      if (e->kind == ExprKind::call && !static_cast<const CallExpr&>(*e).method)
        note(static_cast<const CallExpr&>(*e).name, static_cast<const CallExpr&>(*e).arguments);
    const auto append = [&](const std::string& called, std::vector<Parameter>& parameters) {
      const auto found = named.find(called);
      if (called.empty() || found == named.end()) return;
      for (const std::string& name : found->second) {
        const auto same = [&](const Parameter& p) { return p.name == name; };
        if (std::any_of(parameters.begin(), parameters.end(), same)) continue;
        parameters.emplace_back();
        parameters.back().name = name;
        parameters.back().undeclared = true;
      }
    };
    for (const auto& f : program_.functions) append(f->name, f->parameters);
    for (const auto& m : program_.modules) append(m->name, m->parameters);
  }

  // ---- statements

  /// `arguments`: those of the call whose children the block is, if it sees their variables.
  void block(Body& b, const Scope* outer, Unit* unit, std::vector<Argument>* arguments = nullptr) {
    b.own_frame =
        b.own_frame || !b.functions.empty() || !b.modules.empty() ||
        std::any_of(b.assignments.begin(), b.assignments.end(), [](const auto& a) { return !a.special; });
    Frame own;
    Frame* frame = b.own_frame ? &own : outer->frame;
    Scope scope{.outer = outer,
                .frame = frame,
                .starts_frame = b.own_frame,
                .block = &b,
                .unit = unit,
                .may_be_unset = true};
    for (Assignment& a : b.assignments)
      if (!a.special) scope.variables[a.name] = a.slot = frame->slots++;
    varies_ = false;
    for (Assignment& a : b.assignments) assignment(a, scope);
    if (unit != nullptr) unit->varies = varies_;
    if (arguments != nullptr)
      for (Argument& a : *arguments) expr(a.value, scope);
    for (auto& [name, f] : b.functions) function(*f, scope);
    for (auto& [name, m] : b.modules) module(*m, scope);
    for (Statement* s : b.statements) statement(*s, scope);
    b.slots = own.slots;
  }

  void define(const std::vector<Parameter>& parameters, Scope& scope) {
    for (const Parameter& p : parameters) {
      if (!p.special) scope.variables[p.name] = p.slot;
      scope.may_be_unset = scope.may_be_unset || p.undeclared;
    }
  }

  void assignment(Assignment& a, const Scope& scope) {
    saw_command_ = false;
    expr(a.value, scope);
    if (saw_command_ && a.after_statement)
      diagnostics_
          .warning(codes::scad_order, program_.sources.locate(a.at),
                   fmt::format("{} is assigned before the statements above it run", a.name))
          .hint =
          "assignments of a block run first; use the command in the argument of a statement, or let()";
  }

  void function(Function& f, const Scope& scope) {
    parameters(f.parameters, scope);
    Frame frame;
    Scope inner{.outer = &scope, .frame = &frame, .starts_frame = true};
    give_slots(f.parameters, frame);
    define(f.parameters, inner);
    expr(f.body, inner);
    f.slots = frame.slots;
  }

  void module(Module& m, const Scope& scope) {
    parameters(m.parameters, scope);
    Frame counted;
    give_slots(m.parameters, counted);
    module_body(m, scope, counted.slots);
  }

  /// The parameters have the first slots of the frame of the body.
  void module_body(Module& m, const Scope& scope, std::uint32_t parameter_slots) {
    Body& b = *m.body;
    b.own_frame = true;
    Frame frame{parameter_slots};
    Scope given{.outer = &scope, .frame = &frame, .starts_frame = true};
    define(m.parameters, given);
    if (const auto [it, is_new] = given.variables.try_emplace("$children", frame.slots); is_new)
      m.children_slot = frame.slots++;
    else  // a parameter
      m.children_slot = it->second;
    Scope inner{.outer = &given, .frame = &frame, .block = &b, .may_be_unset = true};
    for (Assignment& a : b.assignments)
      if (!a.special) inner.variables[a.name] = a.slot = frame.slots++;
    for (Assignment& a : b.assignments) assignment(a, inner);
    for (auto& [name, f] : b.functions) function(*f, inner);
    for (auto& [name, n] : b.modules) module(*n, inner);
    for (Statement* s : b.statements) statement(*s, inner);
    b.slots = frame.slots;
  }

  static void give_slots(std::vector<Parameter>& list, Frame& frame) {
    for (Parameter& p : list) {
      if (p.special) continue;
      const auto same =
          std::find_if(list.begin(), list.end(), [&](const auto& q) { return q.name == p.name; });
      p.slot = &*same == &p ? frame.slots++ : same->slot;
    }
  }

  void parameters(std::vector<Parameter>& list, const Scope& scope) {
    for (Parameter& p : list) {
      if (p.standard == nullptr) continue;
      Frame frame;
      const Scope inner{.outer = &scope, .frame = &frame, .starts_frame = true};
      expr(p.standard, inner);
      p.visible = may_print(p);
      p.standard_slots = frame.slots;
    }
  }

  void statement(Statement& s, const Scope& scope) {
    if (s.object != nullptr) expr(s.object, scope);
    if (s.kind == StatementKind::loop || s.kind == StatementKind::let) {
      Frame frame;
      Scope inner{.outer = &scope, .frame = &frame, .starts_frame = true};
      const Scope outside{.outer = &scope, .frame = &frame, .starts_frame = true};
      bind(s.arguments, inner, s.name == "let", s.name == "assign" ? &outside : nullptr);
      block(*s.children, &inner, nullptr);
      s.slots = frame.slots;
      return;
    }
    if (s.kind == StatementKind::call) called_module(s, scope);
    // As in OpenSCAD, the arguments of a module of the program see the variables of its children.
    if (s.module == nullptr)
      for (Argument& a : s.arguments) expr(a.value, scope);
    else
      s.children->captured = s.captured;
    block(*s.children, &scope, nullptr, s.module == nullptr ? nullptr : &s.arguments);
    if (s.otherwise != nullptr) block(*s.otherwise, &scope, nullptr);
  }

  void called_module(Statement& s, const Scope& scope) {
    if (s.object == nullptr) {
      std::uint32_t hops = 0;
      for (const Scope* at = &scope; at != nullptr; at = at->outer) {
        if (at->block != nullptr) s.module = find_module(*at, s.name);
        if (s.module != nullptr) {
          s.module_hops = at->block->modules.count(s.name) == 0 ? kOfUnit : hops;
          s.taken = taken_of(s.module->parameters, s.arguments);
          report_arguments(s.module->parameters, s.arguments, s.name);
          return;
        }
        hops += at->starts_frame ? 1 : 0;
      }
      if (const auto it = known_.modules.find(s.name); it != known_.modules.end()) {
        const KnownModule& known = it->second;
        s.builtin = known.number;
        if (!known.one_argument)
          s.taken = taken_of(known.parameters, known.positional, s.arguments);
        else if (!s.arguments.empty())
          s.taken = {{0, 0}};
        return;
      }
    }
    if (const auto it = known_.commands.find(s.name); it != known_.commands.end()) s.command = it->second;
  }

  static const Module* find_module(const Scope& scope, const std::string& name) {
    if (const auto it = scope.block->modules.find(name); it != scope.block->modules.end()) return it->second;
    if (scope.unit == nullptr) return nullptr;
    for (const Unit* used : scope.unit->used)
      if (const auto it = used->block->modules.find(name); it != used->block->modules.end())
        return it->second;
    return nullptr;
  }
  static const Function* find_function(const Scope& scope, const std::string& name) {
    if (const auto it = scope.block->functions.find(name); it != scope.block->functions.end())
      return it->second;
    if (scope.unit == nullptr) return nullptr;
    for (const Unit* used : scope.unit->used)
      if (const auto it = used->block->functions.find(name); it != used->block->functions.end())
        return it->second;
    return nullptr;
  }

  /// Warnings about arguments that have no parameter.
  void report_arguments(const std::vector<Parameter>& parameters, const std::vector<Argument>& arguments,
                        const std::string& name) {
    std::size_t position = 0;
    bool too_many = false;
    const std::size_t declared = declared_count(parameters);
    for (const Argument& a : arguments) {
      if (a.name.empty()) {
        if (position++ >= declared && !std::exchange(too_many, true))
          diagnostics_.warning(codes::scad_call, program_.sources.locate(a.at),
                               fmt::format("{}() takes {} argument{} at most; this one is not used", name,
                                           declared, declared == 1 ? "" : "s"));
        continue;
      }
      const auto p =
          std::find_if(parameters.begin(), parameters.end(), [&](const auto& q) { return q.name == a.name; });
      if (p != parameters.end() && p->undeclared)
        diagnostics_.warning(
            codes::scad_call, program_.sources.locate(a.at),
            fmt::format("{}() has no parameter {}; it is a variable of the call", name, a.name));
    }
  }

  // ---- expressions

  /// The variables of let, in order: each sees those before it; or of loops. Those of assign() see what
  /// `outside` has.
  void bind(std::vector<Argument>& list, Scope& scope, bool first_counts, const Scope* outside = nullptr) {
    for (Argument& a : list) {
      expr(a.value, outside != nullptr ? *outside : scope);
      if (a.name.empty()) continue;
      if (!a.special) {
        const auto [it, is_new] = scope.variables.try_emplace(a.name, scope.frame->slots);
        if (is_new) ++scope.frame->slots;
        a.slot = it->second;
      }
      a.ignored =
          first_counts && std::any_of(list.data(), &a, [&](const Argument& b) { return b.name == a.name; });
      if (a.ignored)
        diagnostics_.warning(codes::scad_assigned_twice, program_.sources.locate(a.at),
                             fmt::format("{} has a value already; this one is not used", a.name));
    }
  }

  void bind_expr(BindExpr& e, const Scope& scope) {
    Frame own;
    Scope inner{.outer = &scope, .frame = e.own_frame ? &own : scope.frame, .starts_frame = e.own_frame};
    // A function literal sees all variables of its let, also those after it; other expressions do not.
    inner.may_be_unset = e.own_frame;
    if (e.own_frame)
      for (const Argument& a : e.arguments)
        if (!a.special && !a.name.empty() && inner.variables.try_emplace(a.name, own.slots).second)
          ++own.slots;
    bind(e.arguments, inner, e.kind == ExprKind::let);
    if (e.b != nullptr) expr(e.b, inner);
    for (Argument& a : e.steps) {
      expr(a.value, inner);
      if (a.special || a.name.empty()) continue;
      const auto [it, is_new] = inner.variables.try_emplace(a.name, inner.frame->slots);
      if (is_new) ++inner.frame->slots;
      a.slot = it->second;
    }
    if (e.a != nullptr) expr(e.a, inner);
    e.slots = own.slots;
  }

  void variable(Variable& v, const Scope& scope) {
    std::uint32_t hops = 0;
    v.others.clear();
    for (const Scope* at = &scope; at != nullptr; at = at->outer) {
      if (const auto it = at->variables.find(v.name); it != at->variables.end()) {
        if (!v.found) {
          v.found = true;
          v.hops = hops;
          v.slot = it->second;
          if (!at->may_be_unset && hops == 0) v.kind = ExprKind::local;
        } else {
          v.others.push_back({hops, it->second});
        }
        if (!at->may_be_unset) return;
      }
      hops += at->starts_frame ? 1 : 0;
    }
  }

  void call(CallExpr& e, const Scope& scope) {
    if (e.variable != nullptr) {
      variable(*e.variable, scope);
      if (!e.variable->found) e.variable = nullptr;
    }
    if (e.a != nullptr) expr(e.a, scope);
    std::size_t printing = 0;
    bool specials = false;
    for (Argument& a : e.arguments) {
      if (prints([&] { expr(a.value, scope); })) ++printing;
      specials = specials || a.special;
    }
    called_function(e, scope);
    if (e.builtin >= 0) {
      if (specials) e.of_number = nullptr;
      return;
    }
    prints_ = prints_ || has_prints_;
    varies_ = varies_ || (e.command < 0 && (has_prints_ || has_specials_));
    e.ordered = specials || printing > 1;
    if (e.function == nullptr) return;
    for (std::size_t i = 0; i < e.map.size(); ++i)
      e.ordered = e.ordered || e.function->parameters[i].special ||
                  (e.map[i] >= 0 && may_print(e.function->parameters[i]));
  }
  bool may_print(const Parameter& p) const {
    return has_prints_ && p.standard != nullptr && p.standard->kind != ExprKind::constant;
  }

  void called_function(CallExpr& e, const Scope& scope) {
    const auto command = known_.commands.find(e.name);
    if (e.method) {
      if (command != known_.commands.end()) e.command = command->second;
      saw_command_ = saw_command_ || e.command >= 0;
      return;
    }
    std::uint32_t hops = 0;
    for (const Scope* at = &scope; at != nullptr; at = at->outer) {
      if (at->block != nullptr) e.function = find_function(*at, e.name);
      if (e.function != nullptr) {
        e.function_hops = at->block->functions.count(e.name) == 0 ? kOfUnit : hops;
        const std::vector<Parameter>& list = e.function->parameters;
        e.taken = taken_of(list, e.arguments);
        e.map.assign(e.function->parameters.size(), -1);
        for (const Taken& taken : e.taken)
          for (std::size_t i = 0; taken.parameter >= 0 && i < e.map.size();
               ++i)  // also parameters of one name
            if (list[i].name == list[static_cast<std::size_t>(taken.parameter)].name)
              e.map[i] = static_cast<std::int32_t>(taken.argument);
        report_arguments(e.function->parameters, e.arguments, e.name);
        return;
      }
      hops += at->starts_frame ? 1 : 0;
    }
    if (const auto it = known_.functions.find(e.name); it != known_.functions.end()) {
      e.builtin = it->second;
      const auto of_number = known_.of_number.find(e.name);
      if (of_number != known_.of_number.end() && e.arguments.size() == 1 && e.variable == nullptr)
        e.of_number = of_number->second;
    } else if (command != known_.commands.end()) {
      e.command = command->second;
      saw_command_ = true;
    }
  }

  /// Whether what `walk` resolves may print.
  template <class Walk>
  bool prints(Walk walk) {
    const bool before = std::exchange(prints_, false);
    walk();
    const bool does = prints_;
    prints_ = does || before;
    return does;
  }

  void expr(Expr* e, const Scope& scope) {
    if (e == nullptr) return;
    prints_ = prints_ || e->kind == ExprKind::print;
    varies_ = varies_ || e->kind == ExprKind::print || e->kind == ExprKind::special;
    switch (e->kind) {
      case ExprKind::constant:
      case ExprKind::special: return;
      case ExprKind::local:
      case ExprKind::variable: variable(static_cast<Variable&>(*e), scope); return;
      case ExprKind::call: call(static_cast<CallExpr&>(*e), scope); return;
      case ExprKind::vector:
        for (Expr* item : static_cast<VectorExpr*>(e)->items) expr(item, scope);
        return;
      case ExprKind::let:
      case ExprKind::loop:
      case ExprKind::c_loop: bind_expr(static_cast<BindExpr&>(*e), scope); return;
      case ExprKind::check:
      case ExprKind::print:
        for (Argument& a : static_cast<BindExpr*>(e)->arguments) expr(a.value, scope);
        break;
      case ExprKind::literal: function(static_cast<FunctionLiteral*>(e)->function, scope); return;
      default: break;
    }
    expr(e->a, scope);
    expr(e->b, scope);
    expr(e->c, scope);
  }

  Program& program_;
  const KnownNames& known_;
  Diagnostics& diagnostics_;
  bool saw_command_ = false;
  bool has_prints_ = false;    // an expression prints
  bool has_specials_ = false;  // an expression has a special variable
  bool varies_ = false;        // one of those that were resolved last depends on the caller, or prints
  bool prints_ = false;        // one of those that were resolved last may print
};

}  // namespace

void resolve(Program& program, const KnownNames& known, Diagnostics& diagnostics) {
  Resolver(program, known, diagnostics).run();
}

}  // namespace kerf::scad
