// Feeds by the chip load: table of materials, teeth and diameter of the tool, speed, and limits of a machine.
#include "job/cut_feeds.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/op.h"
#include "base/file_names.h"
#include "base/number.h"
#include "job/load_material.h"
#include "job/named.h"

#include "kerf/base/files.h"
#include "kerf/formats/workshop_files.h"
#include "kerf/tool/material.h"

namespace kerf::job_detail {
namespace {

constexpr double kStep = 10.0;  // mm/min: chosen feeds are rounded down to it where they are larger

class FeedChooser {
 public:
  FeedChooser(const std::map<int, Tool>& tools, const std::string& file, std::vector<std::string>& files,
              Diagnostics& diagnostics)
      : tools_(tools), file_(file), files_(files), diagnostics_(diagnostics) {}

  void choose(CutOperation& operation) {
    const auto tool = tools_.find(operation.tool);
    if (tool == tools_.end()) return;  // an error of its own
    const auto material = material_of(operation);
    if (!(operation.speed > SpindleSpeed{}))
      error(operation, "a feed by the chip load needs the spindle speed").hint = "rpm = 16000";
    if (tool->second.teeth < 1)
      error(operation, fmt::format("the number of teeth of tool {} is unknown", operation.tool)).hint =
          "tool = \"square d=6 teeth=2\"";
    const std::optional<Machine> machine = machine_of(operation);
    if (!good || !material) return;
    const Length depth = mm(number_of(operation, "depth").value_or(0.0));
    const Length stepdown = mm(number_of(operation, "stepdown").value_or(0.0));
    const Length deep = depth > Length{} ? depth : tool->second.flute;
    const FeedRequest request{.diameter = 2.0 * cutting_radius(tool->second, deep),
                              .teeth = tool->second.teeth,
                              .speed = operation.speed,
                              .pass_depth = stepdown > Length{} ? std::min(stepdown, deep) : deep};
    if (!(request.diameter > Length{})) return;  // the operation refuses the tool
    const ChosenFeed chosen = choose_feed(*material, request);
    double feed = chosen.feed.mm_per_min();
    if (feed > kStep) feed = std::floor(feed / kStep) * kStep;
    std::string limit;
    if (machine) {
      const double fastest = std::min(machine->rates[0], machine->rates[1]).mm_per_min();
      if (feed > fastest) feed = fastest, limit = ", the limit of the machine";
      check_speed(operation, *machine);
    }
    if (!good) return;
    set_number(operation, "feed", feed);
    choose_plunge(operation);
    const double plunge = number_of(operation, "plunge").value_or(0.0);
    if (machine)
      set_number(operation, "plunge",
                 std::min(plunge > 0.0 ? plunge : 0.5 * feed, machine->rates[2].mm_per_min()));
    note(operation, tool->second, chosen, material->name, limit);
  }

  /// The depth of a pass by the material; a warning where a deep pass is not asked for.
  void choose_depth(CutOperation& operation) {
    const auto tool = tools_.find(operation.tool);
    const CutKey* key = operation.row->key("depth");
    if (tool == tools_.end() || !operation.choose_depths || operation.row->key("stepdown") == nullptr) return;
    // V-carving and meshes find their own depth; adaptive pockets limit the load of the flute otherwise.
    if (key == nullptr || !key->required || is_adaptive(operation)) return;
    const double depth = number_of(operation, "depth").value_or(0.0);
    const double diameter = tool->second.diameter.mm();
    if (operation.material.empty()) {
      if (depth > 1.001 * diameter)
        diagnostics_
            .warning(
                codes::cut_job_key, operation.where,
                fmt::format("{}: one pass of {:.4g} mm is deeper than the diameter of tool {}, {:.4g} mm",
                            operation.name, depth, operation.tool, diameter))
            .hint = fmt::format("stepdown = {:.3g}, or material = \"MDF\"; stepdown = 0 for one pass",
                                0.5 * diameter);
      return;
    }
    const auto material = material_of(operation);
    const double pass = material ? material->pass_depth * diameter : 0.0;
    if (!(pass > 0.0) || depth <= pass) return;
    set_number(operation, "stepdown", pass);
    diagnostics_
        .note(codes::cut_job_key, operation.where,
              fmt::format("{}: passes of at most {:.4g} mm, {:g} diameters, in {}", operation.name, pass,
                          material->pass_depth, material->name))
        .hint = fmt::format("stepdown = {:.4g}", pass);
  }
  /// The feed downwards by the material.
  void choose_plunge(CutOperation& operation) {
    if (!operation.choose_plunge || operation.material.empty() || operation.row->key("plunge") == nullptr)
      return;
    const auto material = material_of(operation);
    const auto feed = number_of(operation, "feed");
    if (material && feed)
      set_number(operation, "plunge", std::max(1.0, std::floor(material->plunge * *feed)));
  }
  bool good = true;

 private:
  static bool is_adaptive(const CutOperation& operation) {
    const CutKey* pattern = operation.row->key("pattern");
    const auto value = pattern != nullptr ? pattern->get(operation) : std::nullopt;
    const auto* name = value ? std::get_if<std::string>(&*value) : nullptr;
    return (name != nullptr && *name == "adaptive") || operation.row->name == "trochoidal-slot";
  }
  Diagnostic& error(const CutOperation& operation, const std::string& message) {
    good = false;
    return diagnostics_.error(codes::cut_job_key, operation.where, operation.name + ": " + message);
  }

  std::optional<Material> material_of(const CutOperation& operation) {
    Diagnostics found;
    const std::string name = located(Named::material, operation.material, used_configuration(), file_);
    const auto end = end_of_material_file(name);
    if (end) note_file(name.substr(0, *end));
    auto material = load_material(name, found);
    for (const Diagnostic& d : found.list())
      if (end)
        diagnostics_.add(d);  // has a location in the file of the material
      else
        error(operation, d.message).hint = d.hint;
    good = good && material;
    return material;
  }

  std::optional<Machine> machine_of(const CutOperation& operation) {
    if (operation.machine.empty()) return std::nullopt;
    const std::string name = located(Named::machine, operation.machine, used_configuration(), file_);
    auto machine = load_machine(name, diagnostics_);
    if (!machine) good = false;
    if (is_regular_file(name)) note_file(name);
    return machine;
  }

  void note_file(const std::string& path) {
    if (std::find(files_.begin(), files_.end(), path) == files_.end()) files_.push_back(path);
  }

  void check_speed(const CutOperation& operation, const Machine& machine) {
    const bool slow = machine.slowest_spindle && operation.speed < *machine.slowest_spindle;
    const bool fast = machine.fastest_spindle && operation.speed > *machine.fastest_spindle;
    if (slow || fast)
      error(operation, fmt::format("{:g} rpm is {} what the spindle of the machine turns, {:g} rpm",
                                   operation.speed.rpm(), slow ? "below" : "above",
                                   (slow ? *machine.slowest_spindle : *machine.fastest_spindle).rpm()));
  }

  /// The number of teeth is that of the tool, or else assumed.
  void note(const CutOperation& operation, const Tool& tool, const ChosenFeed& chosen,
            const std::string& material, const std::string& limit) {
    const bool assumed = tool.teeth_assumed;
    const std::string feed = number_text(number_of(operation, "feed").value_or(0.0), 1);
    Diagnostic& d = assumed ? diagnostics_.warning(codes::cut_job_key, operation.where, "")
                            : diagnostics_.note(codes::cut_job_key, operation.where, "");
    d.message = fmt::format(
        "{}: feed {} mm/min{}: {} mm per tooth in {} at {:g} rpm with {}{}{}", operation.name, feed, limit,
        number_text(chosen.chip_load.mm(), 3), material, operation.speed.rpm(), teeth_text(tool),
        chosen.depth_factor < 1.0
            ? fmt::format(", less by {:.0f}% for the depth", 100.0 * (1.0 - chosen.depth_factor))
            : std::string(),
        operation.choose_plunge && operation.row->key("plunge") != nullptr
            ? fmt::format("; plunge {:g}", number_of(operation, "plunge").value_or(0.0))
            : std::string());
    d.hint = assumed ? fmt::format("teeth={} in the text of the tool if that is right, or feed = {}",
                                   tool.teeth, feed)
                     : fmt::format("feed = {}", feed);
  }

  const std::map<int, Tool>& tools_;
  const std::string& file_;
  std::vector<std::string>& files_;
  Diagnostics& diagnostics_;
};

}  // namespace

bool choose_feeds(CutJob& job, const std::map<int, Tool>& tools, const std::string& file,
                  std::vector<std::string>& files, Diagnostics& diagnostics) {
  bool good = true;
  for (CutOperation& operation : job.operations) {
    FeedChooser chooser(tools, file, files, diagnostics);
    chooser.choose_depth(operation);
    if (operation.choose_feed)
      chooser.choose(operation);
    else
      chooser.choose_plunge(operation);
    good = good && chooser.good;
  }
  return good;
}

}  // namespace kerf::job_detail
