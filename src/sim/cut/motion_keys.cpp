// Hashes of motions, for comparing toolpaths.
#include "sim/cut/motion_keys.h"

#include <algorithm>
#include <cstring>

namespace kerf::sim {
namespace {

/// A 64-bit hash: multiplication spreads each bit upwards, the shift downwards.
class Mixer {
 public:
  void add(std::uint64_t word) {
    hash_ = (hash_ ^ word) * 0x9e3779b97f4a7c15u;
    hash_ ^= hash_ >> 32;
  }
  void add(double number) {
    std::uint64_t word = 0;
    std::memcpy(&word, &number, sizeof word);
    add(word);
  }
  void add(Point3 p) {
    add(p.x);
    add(p.y);
    add(p.z);
  }
  std::uint64_t hash() const { return hash_; }

 private:
  std::uint64_t hash_ = 0x243f6a8885a308d3u;
};

}  // namespace

std::vector<MotionKey> motion_keys(const Toolpath& path, const Survey& survey) {
  std::vector<MotionKey> keys;
  keys.reserve(path.size());
  int tool_before =
      -1;  // of the previous motion, if that cut: the following one need not cut its start again
  for (MotionReader motion(path); motion.next();) {
    const Step& step = motion.step();
    const MotionContext& context = motion.context();
    const int tool = survey.tool_of(context).value_or(-1);
    Mixer mixer;
    mixer.add(static_cast<std::uint64_t>(step.kind()) | std::uint64_t{step.unknown_axes()} << 8 |
              std::uint64_t{context.unknown_from} << 16 |
              std::uint64_t{survey.spindle_off(context) ? 1u : 0u} << 24);
    mixer.add(static_cast<std::uint64_t>(static_cast<std::uint32_t>(tool)) |
              static_cast<std::uint64_t>(static_cast<std::uint32_t>(tool_before)) << 32);
    mixer.add(context.from);
    mixer.add(step.to());
    if (step.kind() == StepKind::arc) {
      const step::Arc arc = step.arc();
      mixer.add(arc.centre.x);
      mixer.add(arc.centre.y);
      mixer.add(static_cast<std::uint64_t>(arc.plane) | static_cast<std::uint64_t>(arc.turn) << 8 |
                static_cast<std::uint64_t>(arc.extra_turns) << 16);
    }
    keys.push_back({mixer.hash(), static_cast<std::uint32_t>(context.index)});
    tool_before = step.is_cutting() ? tool : -1;
  }
  return keys;
}

MotionChange change_of(const std::vector<MotionKey>& old_keys, const std::vector<MotionKey>& new_keys) {
  const auto same = [](const MotionKey& a, const MotionKey& b) { return a.hash == b.hash; };
  const auto [old_first, new_first] =
      std::mismatch(old_keys.begin(), old_keys.end(), new_keys.begin(), new_keys.end(), same);
  const auto first = static_cast<std::size_t>(old_first - old_keys.begin());
  std::size_t old_end = old_keys.size(), new_end = new_keys.size();
  while (old_end > first && new_end > first && same(old_keys[old_end - 1], new_keys[new_end - 1]))
    --old_end, --new_end;
  return {first, old_end, new_end};
}

std::vector<StepShift> step_shifts(const std::vector<MotionKey>& old_keys,
                                   const std::vector<MotionKey>& new_keys, const MotionChange& change) {
  std::vector<StepShift> shifts;
  const auto add = [&](std::uint32_t before, std::uint32_t now) {
    const auto by = static_cast<std::int32_t>(static_cast<std::int64_t>(now) - before);
    const std::int32_t in_force = shifts.empty() ? 0 : shifts.back().by;
    if (by != in_force) shifts.push_back({before, by});
  };
  for (std::size_t m = 0; m < change.first; ++m) add(old_keys[m].step, new_keys[m].step);
  for (std::size_t m = change.old_end; m < old_keys.size(); ++m)
    add(old_keys[m].step, new_keys[change.moved(m)].step);
  return shifts;
}

}  // namespace kerf::sim
