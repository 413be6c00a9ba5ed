// Faults of a print that its steps show.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "path/firmware_commands.h"
#include "path/firmware_retraction.h"

#include "kerf/path/check.h"

namespace kerf {
namespace {

constexpr double kNoLength = 1e-6;           // mm
constexpr double kFlowSlack = 1e-3;          // of the maximum: rounded E and F words
constexpr double kBedSlack = 1e-3;           // mm
constexpr double kSameRetraction = 0.01;     // mm3; less is rounding
constexpr double kSecondRetraction = 0.5;    // mm3, of each of two: 0.2 mm of usual filament
constexpr Duration kLongWait = seconds(60);  // heats a nozzle too
constexpr Length kArcChord = mm(0.05);
constexpr int kMaxChords = 1000;

class Checker {
 public:
  Checker(const Toolpath& path, const PrinterLimits& limits) : path_(path), limits_(limits) {}

  std::vector<PrintFault> run() {
    PathPosition here;
    for (std::size_t i = 0; i < path_.size(); ++i) {
      const Step& s = path_[i];
      if (s.kind() == StepKind::extruder) extruder_ = s.extruder().number;
      if (s.kind() == StepKind::temperature) heat(s.temperature());
      if (s.kind() == StepKind::verbatim) firmware(path_.text(i));
      if (s.kind() == StepKind::pause || (s.kind() == StepKind::dwell && s.dwell().time >= kLongWait))
        waited_ = true;
      if (s.is_motion()) motion(i, here);
      here.pass(s);
    }
    std::stable_sort(faults_.begin(), faults_.end(),
                     [](const PrintFault& a, const PrintFault& b) { return a.step < b.step; });
    return std::move(faults_);
  }

 private:
  struct Filament {
    std::optional<double> celsius;
    bool by_firmware = false;                                             // drawn back by G10
    double drawn_back = 0.0;                                              // mm3
    std::size_t last_back = std::numeric_limits<std::size_t>::max() - 1;  // the motion
  };

  void heat(const step::Temperature& t) {
    if (t.heater != Heater::nozzle) return;
    filaments_[t.extruder < 0 ? extruder_ : t.extruder].celsius = t.celsius;
    waited_ = waited_ || (t.wait && t.celsius >= limits_.min_celsius);
  }

  void firmware(std::string_view text) {
    const RetractionLine line = read_firmware_retraction(text).line;
    if (line == RetractionLine::back || line == RetractionLine::forth)
      filaments_[extruder_].by_firmware = line == RetractionLine::back;
    if (line != RetractionLine::none) return;
    const CommandEffect effect = firmware_command(text).effect;
    if (effect == CommandEffect::unknown || effect == CommandEffect::heat) lose_temperatures();
  }

  /// A macro, or a command that is not known, may heat and wait.
  void lose_temperatures() {
    waited_ = true;
    for (auto& [extruder, filament] : filaments_) filament.celsius.reset();
  }

  /// Of several extruders one may have the nozzle that another one's command has heated.
  bool is_cold(const Filament& filament) const {
    return filament.celsius && (*filament.celsius < limits_.min_celsius || !waited_);
  }

  void motion(std::size_t i, const PathPosition& here) {
    const Step& s = path_[i];
    const bool known = here.is_known() && s.unknown_axes() == 0;
    // A line with a feed alone, as slicers write between the parts of a wipe, is no motion.
    if (s.kind() == StepKind::cut && known && distance(here.at, s.to()) <= kNoLength) return;
    ++motions_;
    if (limits_.bed && s.unknown_axes() == 0) bed(i, here);
    if (s.kind() != StepKind::extrude) return;
    const double volume = path_.extrude(i).volume.mm3();
    Filament& filament = filaments_[extruder_];
    if (volume > 0.0 && is_cold(filament))
      add(PrintFaultKind::cold_extrusion, i, *filament.celsius, -*filament.celsius);
    if (known && limits_.max_flow > VolumeFlow{}) {
      const VolumeFlow flow = flow_of(path_, i, here.at);
      if (flow > (1.0 + kFlowSlack) * limits_.max_flow)
        add(PrintFaultKind::flow_high, i, in_mm3_per_s(flow), in_mm3_per_s(flow));
    }
    retraction(i, filament, volume, distance(here.at.xy(), s.to().xy()) <= kNoLength);
  }

  /// A wipe draws the filament back in several motions; another one after a travel is a second retraction.
  void retraction(std::size_t i, Filament& filament, double volume, bool stationary) {
    double& drawn_back = filament.drawn_back;
    if (volume >= 0.0) {
      if (!stationary && volume > kSameRetraction && (drawn_back > 0.0 || filament.by_firmware))
        add(PrintFaultKind::extruded_drawn_back, i, std::min(drawn_back, volume), drawn_back);
      drawn_back = std::max(drawn_back - volume, 0.0);
      if (drawn_back < kSameRetraction) drawn_back = 0.0;
      return;
    }
    const bool continues = filament.last_back + 1 == motions_;
    if (drawn_back >= kSecondRetraction && -volume >= kSecondRetraction && !continues)
      add(PrintFaultKind::retracted_twice, i, drawn_back - volume, drawn_back - volume);
    drawn_back -= volume;
    filament.last_back = motions_;
  }

  double outside(Point3 p) const {
    double farthest = 0.0;
    for (int axis = 0; axis < 3; ++axis)
      farthest = std::max({farthest, limits_.bed->low[axis] - p[axis], p[axis] - limits_.bed->high[axis]});
    return farthest;
  }

  void bed(std::size_t i, const PathPosition& here) {
    const Step& s = path_[i];
    double farthest = outside(s.to());
    if (s.kind() == StepKind::arc && here.is_known()) {
      const ArcWalk walk = walk_of(s, here.at);
      const int chords = walk.chords(kArcChord, kMaxChords);
      for (int k = 1; k < chords; ++k) farthest = std::max(farthest, outside(walk.at(k / double(chords))));
    }
    if (farthest > kBedSlack) add(PrintFaultKind::outside_bed, i, farthest, farthest);
  }

  /// `worse`: the larger one is the worst of an entry.
  void add(PrintFaultKind kind, std::size_t i, double value, double worse) {
    Open& open = open_[static_cast<std::size_t>(kind)];
    if (open.motion + 1 == motions_ || open.motion == motions_) {
      PrintFault& fault = faults_[open.index];
      fault.steps += open.motion == motions_ ? 0 : 1;
      open.motion = motions_;
      if (worse <= open.worst) return;
      open.worst = worse;
      fault.value = value;
      fault.at = path_[i].to();
      return;
    }
    open = {faults_.size(), motions_, worse};
    faults_.push_back({kind, static_cast<std::uint32_t>(i), 1, path_[i].to(), value});
  }

  struct Open {
    std::size_t index = 0;
    std::size_t motion = std::numeric_limits<std::size_t>::max() - 1;  // of its last step
    double worst = 0.0;
  };
  const Toolpath& path_;
  const PrinterLimits& limits_;
  std::vector<PrintFault> faults_;
  Open open_[kPrintFaultKinds];
  std::map<int, Filament> filaments_;  // by extruder
  int extruder_ = 0;
  bool waited_ = false;  // for a nozzle that is hot enough, so far
  std::size_t motions_ = 0;
};

}  // namespace

std::string_view to_string(PrintFaultKind kind) {
  switch (kind) {
    case PrintFaultKind::cold_extrusion: return "cold_extrusion";
    case PrintFaultKind::flow_high: return "flow_high";
    case PrintFaultKind::outside_bed: return "outside_bed";
    case PrintFaultKind::extruded_drawn_back: return "extruded_drawn_back";
    case PrintFaultKind::retracted_twice: break;
  }
  return "retracted_twice";
}

VolumeFlow flow_of(const Toolpath& path, std::size_t i, Point3 from) {
  if (path[i].kind() != StepKind::extrude) return {};
  const step::Extrude bead = path.extrude(i);
  const double way = distance(from, bead.to);
  if (!(bead.volume > Volume()) || way <= kNoLength || distance(from.xy(), bead.to.xy()) <= kNoLength)
    return {};
  return VolumeFlow::raw(bead.volume.mm3() / way * bead.feed.mm_per_min());
}

std::vector<PrintFault> check_print(const Toolpath& path, const PrinterLimits& limits) {
  return Checker(path, limits).run();
}

}  // namespace kerf
