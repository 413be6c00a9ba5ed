// The figures of a print that do not need its material.
#include <algorithm>
#include <map>

#include "sim/print/print_survey.h"

namespace kerf {
namespace {

class FigureSink final : public printing::BeadSink {
 public:
  explicit FigureSink(PrintFigures& out) : out_(out), survey_(nullptr) {}

  void bead(const printing::Bead& b) override {
    survey_.bead(b);
    if (!out_.first_bead) out_.first_bead = b.step;
    out_.extruded = out_.extruded + mm3(b.volume);
    double& height = heights_[b.level];
    height = std::max(height, b.section.height);
  }
  void blob(std::uint32_t, Point3, double volume) override {
    out_.blobs = out_.blobs + mm3(volume);
    out_.extruded = out_.extruded + mm3(volume);
  }
  void unplaced(double volume) override { out_.extruded = out_.extruded + mm3(volume); }
  void finish() {
    survey_.sort_levels();
    for (const double z : survey_.levels) out_.layers.push_back({mm(z), mm(0)});
    for (const auto& [level, height] : heights_) {
      PrintFigures::Layer& layer = out_.layers[survey_.layer_of(level)];
      layer.height = mm(std::max(layer.height.mm(), height));
    }
    out_.beads = survey_.beads;
    out_.bead_length = mm(survey_.length);
    out_.box = survey_.box;
  }

 private:
  PrintFigures& out_;
  printing::PrintSurvey survey_;
  std::map<double, double> heights_;  // by level, mm
};

}  // namespace

PrintFigures figures_of_print(const Toolpath& path, const PrintOptions& options) {
  PrintFigures out;
  FigureSink sink(out);
  printing::for_each_bead(path, options, sink, nullptr);
  sink.finish();
  return out;
}

}  // namespace kerf
