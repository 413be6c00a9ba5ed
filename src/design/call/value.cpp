// Values of commands as conditions and as text.
#include "design/call/value.h"

#include <fmt/format.h>

#include "base/number.h"

namespace kerf::design {
namespace {

constexpr std::size_t kMaxText = 100'000;  // bytes: a small value can hold itself many times
constexpr int kDigits = 6;                 // significant ones of a number

void append(std::string& text, const Value& value, bool inside) {
  switch (value.type()) {
    case Type::unset:
    case Type::undefined: text += "undef"; return;
    case Type::truth: text += value.truth() ? "true" : "false"; return;
    case Type::number: text += fmt::format("{:.{}g}", value.number(), kDigits); return;
    case Type::text: text += inside ? "\"" + value.text() + "\"" : value.text(); return;
    case Type::outlines: text += value.outlines().single ? "an outline" : "outlines"; return;
    case Type::surface: text += "a surface"; return;
    case Type::other: text += value.other(); return;
    case Type::list: break;
  }
  text += "[";
  bool first = true;
  for (const Value& item : value.list()) {
    if (text.size() > kMaxText) break;
    if (!first) text += ", ";
    first = false;
    append(text, item, true);
  }
  text += "]";
}

}  // namespace

struct Value::Content {
  std::string text = {};
  List list = {};
  Outlines outlines = {};
  std::shared_ptr<const Surface> surface = {};
};

Value::Value(Type type, Content content)
    : type_(type), content_(std::make_shared<const Content>(std::move(content))) {}
Value::Value(std::string text) : Value(Type::text, Content{.text = std::move(text)}) {}
Value::Value(List list) : Value(Type::list, Content{.list = std::move(list)}) {}
Value::Value(Outlines outlines) : Value(Type::outlines, Content{.outlines = std::move(outlines)}) {}
Value::Value(std::shared_ptr<const Surface> surface)
    : Value(Type::surface, Content{.surface = std::move(surface)}) {}
Value::Value(Other other) : Value(Type::other, Content{.text = std::move(other.text)}) {}

const Value::Content& Value::content([[maybe_unused]] Type type) const {
  assert(type_ == type);
  return *content_;
}
const std::string& Value::text() const { return content(Type::text).text; }
const Value::List& Value::list() const { return content(Type::list).list; }
const Outlines& Value::outlines() const { return content(Type::outlines).outlines; }
const std::shared_ptr<const Surface>& Value::surface() const { return content(Type::surface).surface; }
const std::string& Value::other() const { return content(Type::other).text; }

bool Value::is_true() const {
  switch (type()) {
    case Type::unset:
    case Type::undefined: return false;
    case Type::truth: return truth();
    case Type::number: return number() != 0.0;
    case Type::text: return !text().empty();
    case Type::list: return !list().empty();
    default: return true;
  }
}

std::string text_of(const Value& value) {
  std::string text;
  append(text, value, false);
  return text;
}

}  // namespace kerf::design
