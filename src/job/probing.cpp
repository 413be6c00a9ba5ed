// Programs that measure the heights of a grid.
#include "job/probing.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "base/codes/gcode.h"
#include "base/codes/pathdxf.h"
#include "base/number.h"

namespace kerf {
namespace {

constexpr double kTravel = 3000.0;  // mm/min, of firmware whose rapids have a feed
constexpr double kLift = 600.0;     // mm/min

enum class Way : std::uint8_t {
  motions,  // G38.2 or G31 of the post
  bed,      // G30 at each point
  macro,    // PROBE at each point
  mesh,     // one command measures the grid
  none      // what is measured is lost
};

/// What a controller does with the results of probes. {}: the name of the program.
struct Store {
  std::string_view post;
  Way way = Way::motions;
  std::string_view open, close;  // lines around the motions
  std::string_view result;
};
constexpr std::string_view kConsole = "save the console log: it shows each point as [PRB:...]";
constexpr std::array kStores{
    Store{"grbl", Way::motions, "", "", kConsole},
    Store{"grblhal", Way::motions, "", "", kConsole},
    Store{"fluidnc", Way::motions, "", "", kConsole},
    Store{"linuxcnc", Way::motions, "(PROBEOPEN {}.txt)", "(PROBECLOSE)",
          "LinuxCNC writes the points to {}.txt in the folder of its configuration"},
    Store{"mach3", Way::motions, "M40", "M41", "Mach3 asks for the file to which it writes the points"},
    Store{"marlin", Way::bed, "", "", "save the console log: it shows each point as Bed X: Y: Z:"},
    Store{"klipper", Way::macro, "", "", "save the console log: it shows each point as probe at X,Y is z="},
    Store{"reprapfirmware", Way::mesh, "", "", "the controller writes the points to /sys/heightmap.csv"},
    Store{"carbide", Way::none, "", "", ""},
    Store{"laser", Way::none, "", "", ""},
};

Point2 point_of(const ProbingGrid& grid, int column, int row) {
  const auto at = [](double low, double high, int k, int count) {
    return count < 2 ? low : low + (high - low) * k / (count - 1);
  };
  return {at(grid.area.low.x, grid.area.high.x, column, grid.columns),
          at(grid.area.low.y, grid.area.high.y, row, grid.rows)};
}

/// Row by row, back and forth.
template <class Visit>
void for_each_point(const ProbingGrid& grid, Visit&& visit) {
  for (int row = 0; row < grid.rows; ++row)
    for (int k = 0; k < grid.columns; ++k)
      visit(point_of(grid, row % 2 == 0 ? k : grid.columns - 1 - k, row));
}

/// The commands of firmware for printers, which measure with their own probe.
std::string firmware_text(const ProbingGrid& grid, Way way) {
  const auto n = [](double value) { return number_text(value, 3); };
  const std::string lift = fmt::format("G1 Z{} F{}\n", n(grid.clearance.mm()), n(kLift));
  std::string out =
      fmt::format("; measures {} x {} heights; home all axes first\nG21\nG90\n", grid.columns, grid.rows);
  if (way == Way::macro) out.erase(out.find("G21\n"), 4);  // Klipper has mm alone
  if (way == Way::mesh)
    return out + fmt::format("M557 X{}:{} Y{}:{} P{}:{}\nG29 S0\n", n(grid.area.low.x), n(grid.area.high.x),
                             n(grid.area.low.y), n(grid.area.high.y), grid.columns, grid.rows);
  out += lift;
  for_each_point(grid, [&](Point2 p) {
    if (way == Way::bed)
      out += fmt::format("G30 X{} Y{}\n", n(p.x), n(p.y));
    else
      out += fmt::format("G1 X{} Y{} F{}\nPROBE PROBE_SPEED={}\n{}", n(p.x), n(p.y), n(kTravel),
                         n(grid.feed.mm_per_min() / 60.0), lift);
  });
  return out + lift;
}

const Store* store_of(std::string_view post) {
  for (const Store& s : kStores)
    if (s.post == post) return &s;
  return nullptr;
}

Toolpath with_lines(const Toolpath& motions, const std::string& open, const std::string& close) {
  if (open.empty()) return motions;
  Toolpath out;
  const OriginId origin = out.origins().add(CallLocation{"", 0, "probing_program"});
  out.add(step::Verbatim{open}, origin);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (motions[i].kind() == StepKind::end) out.add(step::Verbatim{close}, origin);
    out.add_copy(motions, i);
  }
  return out;
}

}  // namespace

Toolpath probing_program(const ProbingGrid& grid, ProbeKind kind) {
  constexpr unsigned kX = 1, kY = 2, kZ = 4;
  Toolpath path;
  const OriginId origin = path.origins().add(CallLocation{"", 0, "probing_program"});
  const double clear = grid.clearance.mm();
  path.set_unknown_axes(path.add(step::Rapid{{0.0, 0.0, clear}}, origin), kX | kY);
  for_each_point(grid, [&](Point2 p) {
    path.add(step::Rapid{{p.x, p.y, clear}}, origin);
    const std::size_t i = path.add(step::Probe{{p.x, p.y, -grid.depth.mm()}, grid.feed, kind}, origin);
    path.set_unknown_axes(i, kZ);
    path.add(step::Rapid{{p.x, p.y, clear}}, origin);
  });
  path.add(step::End{true}, origin);
  return path;
}

Duration probing_time(const ProbingGrid& grid) {
  constexpr double kPause = 0.2;  // seconds at each point: contact, and the report
  const double dx = (grid.area.high.x - grid.area.low.x) / std::max(grid.columns - 1, 1);
  const double dy = (grid.area.high.y - grid.area.low.y) / std::max(grid.rows - 1, 1);
  const double across = grid.rows * (grid.columns - 1) * dx + (grid.rows - 1) * dy;
  const double points = grid.columns * grid.rows;
  return seconds(points * (60.0 * grid.clearance.mm() / grid.feed.mm_per_min() +
                           60.0 * grid.clearance.mm() / kLift + kPause) +
                 60.0 * across / kTravel);
}

std::optional<ProbingText> write_probing(const ProbingGrid& grid, const PostTarget& target,
                                         const std::string& name, Diagnostics& diagnostics) {
  const CallLocation where{"", 0, "--to"};
  const Store* store = store_of(target.profile->name);
  if (store != nullptr && store->way == Way::none) {
    diagnostics
        .error(codes::level_controller, where,
               fmt::format("{} neither shows nor stores what it measures", target.profile->title))
        .hint = "write the program for another controller; kerf post --list prints their names";
    return std::nullopt;
  }
  if (store != nullptr && store->way != Way::motions)
    return ProbingText{firmware_text(grid, store->way), std::string(store->result)};
  // Mach3 has G31 alone.
  constexpr int kContactOrError = 382, kContact = 383, kSkip = 310;
  const auto has = [&](int tenths) { return target.profile->has_g(tenths); };
  if (!has(kContactOrError) && !has(kContact) && !has(kSkip)) {
    diagnostics
        .error(codes::post_cannot, where,
               fmt::format("{} has no probing motion (G38.2), which the {} points of the grid need",
                           target.profile->title, grid.columns * grid.rows))
        .hint = "write the program for another controller; kerf post --list prints their names";
    return std::nullopt;
  }
  if (store == nullptr)
    diagnostics
        .warning(
            codes::level_controller, where,
            fmt::format("it is unknown whether {} shows or stores what it measures", target.profile->title))
        .hint = "save the log of the controller, if it shows the results of probes";
  const auto named = [&](std::string_view text) {
    const std::size_t at = text.find("{}");
    std::string out(text);
    return at == std::string_view::npos ? out : out.replace(at, 2, name);
  };
  Program probing;
  probing.path =
      probing_program(grid, has(kContactOrError) ? ProbeKind::contact_or_error : ProbeKind::contact);
  if (store != nullptr) probing.path = with_lines(probing.path, named(store->open), named(store->close));
  const auto files = post_program(probing, target, {}, diagnostics);
  if (diagnostics.has_errors() || files.empty()) return std::nullopt;
  return ProbingText{files.front().text, store == nullptr ? std::string() : named(store->result)};
}

}  // namespace kerf
