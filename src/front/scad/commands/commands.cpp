// The machine's commands as those of OpenSCAD programs: the table, and the site of a call.
#include "front/scad/commands/commands.h"

#include "base/codes/scad.h"
#include "design/commands/commands.h"
#include "front/scad/commands/values.h"

namespace kerf::scad {
namespace {

class MachineState final : public CommandState {
 public:
  explicit MachineState(const design::MachineOptions& options) : machine(options) {}
  design::Machine machine;
};

/// The value of gcodepreview(), by which commands can be called as methods.
class MachineObject final : public Object {
 public:
  std::string text() const override { return "gcodepreview()"; }
};

class ProgramSite final : public design::CallSite {
 public:
  explicit ProgramSite(Call& call) : call_(call) {}
  Origin where() const override { return call_.where(); }
  OriginId origin(OriginTable& origins) override { return call_.origin(origins); }
  void error(design::Problem problem, std::string message) override {
    call_.error(problem == design::Problem::state ? codes::scad_call : codes::scad_argument,
                std::move(message));
  }
  void warning(std::string message) override { call_.warning(codes::scad_argument, std::move(message)); }
  Diagnostics& diagnostics() override { return call_.diagnostics(); }
  void print(std::string_view line) override { call_.site().print(line); }
  std::string shown(const design::Value& value) const override {
    if (value.is(design::Type::list)) return "a vector";
    if (value.is(design::Type::surface)) return "a function";
    if (value.is(design::Type::text)) return "\"" + value.text() + "\"";
    return as_text(value);
  }
  std::string as_text(const design::Value& value) const override {
    if (value.is(design::Type::other)) return value.other();
    return scad::as_text(from_design(value));
  }
  std::optional<std::vector<Outline>> children() override {
    if (call_.site().child_count() == 0) return std::nullopt;
    Shape shape = call_.site().children();
    if (shape.kind != Shape::Kind::area) return std::vector<Outline>();
    return std::move(shape.region.loops);
  }
  std::optional<double> variable(std::string_view name) const override {
    const Value value = call_.site().variable(name);
    if (!value.is_number()) return std::nullopt;
    return value.number();
  }

 private:
  Call& call_;
};

Value run_command(Call& call) {
  const auto number = static_cast<std::size_t>(&call.command() - commands().data());
  const design::Command& command = design::commands()[number];
  std::vector<design::Value> arguments;
  arguments.reserve(call.arguments().size());
  for (const Value& value : call.arguments()) arguments.push_back(to_design(value, call.site()));
  ProgramSite site(call);
  design::Call inner(command, site, arguments);
  design::Machine& machine = call.state<MachineState>().machine;
  const bool was_started = machine.started();
  const Value result = from_design(design::run(machine, inner));
  if (!was_started && machine.started()) return Value::of(Type::object, new MachineObject);
  return result;
}

/// The first parameter of a call in either form of a command.
std::size_t first_of_form(const Command& command, std::size_t numbers,
                          std::span<const std::string_view> names) {
  const auto number = static_cast<std::size_t>(&command - commands().data());
  return design::first_parameter(design::commands()[number], numbers, names);
}

std::vector<Command> make_table() {
  std::vector<Command> table;
  for (const design::Command& command : design::commands()) {
    std::vector<CommandParameter> parameters;
    for (std::size_t i = 0; i < command.parameters.size(); ++i) {
      const design::Parameter& p = command.parameters[i];
      if (!command.may_leave_out(i))
        parameters.emplace_back(p.name);
      else
        parameters.emplace_back(p.name, from_design(p.standard));
    }
    table.push_back(
        {command.name, std::move(parameters), run_command,
         command.further == design::Further::taken ? FurtherArguments::taken : FurtherArguments::refused,
         command.numbers_without_tool ? first_of_form : nullptr, design::forms_of(command)});
  }
  return table;
}

}  // namespace

const std::vector<Command>& commands() {
  static const std::vector<Command> table = make_table();
  return table;
}

std::unique_ptr<CommandState> make_state(const design::MachineOptions& options) {
  return std::make_unique<MachineState>(options);
}

design::Results finish(CommandState& state, Diagnostics& diagnostics) {
  return design::finish(static_cast<MachineState&>(state).machine, [&](std::string message) {
    diagnostics.warning(codes::scad_call, {}, std::move(message));
  });
}

}  // namespace kerf::scad
