// Pictures of toolpaths: the stock before the first cut, with the motions as lines over it.
#include <algorithm>
#include <cmath>
#include <vector>

#include "codec/picture/image_files.h"
#include "job/picture_marks.h"

#include "kerf/job/outputs.h"

namespace kerf {
namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr Colour kRapidColour{196, 92, 40};
constexpr Colour kWeakBeam{244, 190, 150}, kStrongBeam{120, 8, 8};  // of a laser, by its power
constexpr std::array<Colour, 6> kCutColours{{{24, 84, 160},
                                             {22, 120, 60},
                                             {130, 50, 150},
                                             {0, 128, 140},
                                             {160, 30, 90},
                                             {110, 100, 0}}};  // by tool, cyclically
constexpr unsigned kXY = 3;                                    // axes, see Step::unknown_axes
constexpr double kChord = 4000.0;  // size of the picture / deviation of a chord from its arc
constexpr int kMaxChords = 1 << 14;
constexpr double kRoomForRapids = 0.25;  // around stock and cuts, as a fraction of their size

/// The motions at known positions.
template <class Visit>
void for_each_line(const Toolpath& path, double size, Visit&& visit) {
  for_each_motion(path, [&](const Step& s, const MotionContext& context) {
    const bool unknown = ((s.unknown_axes() | context.unknown_from) & kXY) != 0;
    if (unknown || s.reference() == Reference::end_switches) return;
    if (s.kind() != StepKind::arc) return visit(s, context, context.from, s.to());
    const ArcWalk walk = walk_of(s, context.from);
    const int chords = std::min(walk.chords(mm(size / kChord)), kMaxChords);
    Point3 last = context.from;
    for (int i = 1; i <= chords; ++i) {
      const Point3 at = i == chords ? s.to() : walk.at(static_cast<double>(i) / chords);
      visit(s, context, last, at);
      last = at;
    }
  });
}

/// Whether a motion is drawn as work: a cut, or in a print a bead.
class Work {
 public:
  explicit Work(const Toolpath& path) : path_(path), prints_(is_print(path)) {}
  bool operator()(const Step& s, const MotionContext& context) const {
    if (!prints_) return s.is_cutting();
    return s.kind() == StepKind::extrude && path_.extrude(context.index).volume > Volume();
  }

 private:
  const Toolpath& path_;
  bool prints_;
};

bool is_in(const Box3& box, Point3 p) {
  return p.x >= box.low.x && p.y >= box.low.y && p.z >= box.low.z && p.x <= box.high.x && p.y <= box.high.y &&
         p.z <= box.high.z;
}

/// The stock, else the cuts: what sizes are of. `all`: both.
Box3 box_of_work(const Job& job, bool all) {
  Box3 box;
  if (job.stock) box.add(job.stock->block);
  if (job.stock && !all) return box;
  const Work works(job.program.path);
  for_each_line(job.program.path, 1e3,
                [&](const Step& s, const MotionContext& context, Point3 from, Point3 to) {
                  if (!works(s, context)) return;
                  box.add(from);
                  box.add(to);
                });
  return box;
}

/// The stock and the cuts, and rapids near them.
Box3 visible_box(const Job& job) {
  Box3 box = box_of_work(job, true);
  const bool any = !box.empty();
  const Point3 room = any ? kRoomForRapids * box.size() : Point3{};
  const double around = std::max({room.x, room.y, room.z});
  Box3 near = box;
  if (any) {
    near.low = box.low - Point3{around, around, around};
    near.high = box.high + Point3{around, around, around};
  }
  for_each_line(job.program.path, 1e3, [&](const Step&, const MotionContext&, Point3 from, Point3 to) {
    for (const Point3 p : {from, to})
      if (!any || is_in(near, p)) box.add(p);
  });
  return box;
}

/// The stock, or nothing, with the corners of `visible` as vertices without a triangle.
Mesh mesh_of_stock(const Job& job, const Box3& visible) {
  Mesh mesh;
  const auto add = [&](const Box3& b) {
    for (int corner = 0; corner < 8; ++corner)
      for (int axis = 0; axis < 3; ++axis)
        mesh.positions.push_back(static_cast<float>((corner >> axis & 1) != 0 ? b.high[axis] : b.low[axis]));
  };
  if (job.stock) {
    add(job.stock->block);
    mesh.triangles = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                      2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    mesh.step.assign(mesh.triangles.size() / 3, kStockSurface);
  }
  if (!visible.empty()) add(visible);
  return mesh;
}

/// The colour of the cuts with a laser, or with the tool in force.
class CutColours {
 public:
  explicit CutColours(const Toolpath& path) : path_(path), laser_(path.has(StepKind::laser_power)) {
    for (const Step& s : path.steps())
      if (s.kind() == StepKind::laser_power) strongest_ = std::max(strongest_, s.laser_power().power);
  }

  /// Nothing: a laser's motion without its beam. Called for motions in their order.
  std::optional<Colour> of(const MotionContext& context) {
    for (; next_ <= context.index; ++next_) {
      const Step& s = path_[next_];
      if (s.kind() == StepKind::laser_power)
        power_ = s.laser_power().mode == LaserMode::off ? 0.0 : s.laser_power().power;
      if (s.kind() == StepKind::tool_change) note_tool(s.tool_change().tool);
    }
    if (!laser_) return kCutColours[colour_ % kCutColours.size()];
    if (!(power_ > 0.0)) return std::nullopt;
    const double t = power_ / strongest_;
    Colour mixed{};
    for (std::size_t c = 0; c < 3; ++c)
      mixed[c] = static_cast<std::uint8_t>(std::lround((1.0 - t) * kWeakBeam[c] + t * kStrongBeam[c]));
    return mixed;
  }

 private:
  void note_tool(int tool) {
    const auto it = std::find(tools_.begin(), tools_.end(), tool);
    colour_ = static_cast<std::size_t>(it - tools_.begin());
    if (it == tools_.end()) tools_.push_back(tool);
  }

  const Toolpath& path_;
  bool laser_;
  double strongest_ = 0.0, power_ = 0.0;
  std::size_t next_ = 0, colour_ = 0;
  std::vector<int> tools_;
};

/// The colours of the motions, as CutColours has them.
std::vector<LegendEntry> legend_of(const Job& job) {
  std::vector<LegendEntry> legend;
  const Toolpath& path = job.program.path;
  if (path.has(StepKind::laser_power))
    legend = {{"full power", kStrongBeam}, {"no power", kWeakBeam}};
  else if (is_print(path))
    legend.emplace_back("bead", kCutColours[0]);
  else
    for (const auto& [tool, colour] : tool_colours(path))
      legend.emplace_back("tool " + std::to_string(tool), kCutColours[legend.size() % kCutColours.size()]);
  if (legend.empty()) legend.emplace_back("cut", kCutColours[0]);
  legend.emplace_back(is_print(path) ? "travel" : "rapid", kRapidColour);
  return legend;
}

}  // namespace

std::string path_picture(const Job& job, const View& view) {
  constexpr Colour kStock{226, 206, 172};
  const Box3 visible = visible_box(job);
  const double size = visible.empty() ? 1.0 : length(visible.size());
  const Mesh mesh = mesh_of_stock(job, visible);
  const std::vector<Colour> colours(mesh.triangles.size() / 3, kStock);
  CutColours cut_colours(job.program.path);
  const Work works(job.program.path);
  const auto lines = [&](const std::function<void(const PictureLine&)>& draw) {
    for_each_line(job.program.path, size,
                  [&](const Step& s, const MotionContext& context, Point3 from, Point3 to) {
                    const auto cut = works(s, context) ? cut_colours.of(context) : std::nullopt;
                    draw({from, to, cut.value_or(kRapidColour), !cut});
                  });
  };
  View shown = view;
  const Box3 sized = box_of_work(job, false);
  const auto marks = draw_marks(shown, sized.empty() ? visible : sized, legend_of(job));
  const auto all_lines = [&](const std::function<void(const PictureLine&)>& draw) {
    lines(draw);
    for (const PictureLine& line : marks) draw(line);
  };
  const Image image = render(mesh, colours, shown, all_lines);
  return write_png({image.width, image.height, image.rgba});
}

bool write_path(const std::vector<PartFile>& files, const Job& job, const View& view, OutputSet& set,
                Diagnostics& diagnostics) {
  if (files.empty()) return true;
  const std::string bytes = path_picture(job, view);
  return std::all_of(files.begin(), files.end(),
                     [&](const PartFile& file) { return set.write(file.path, bytes, diagnostics); });
}

}  // namespace kerf
