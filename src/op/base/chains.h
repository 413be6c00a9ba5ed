// Chains of cuts of a finished toolpath: what is cut between two rapids.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "op/base/cutter.h"

namespace kerf::op_detail {

/// Whether step `i` is a cut at a known position without rotary axes or probed heights.
bool is_plain_cut(const Toolpath& path, std::size_t i);
/// One past the last cut of the chain that starts with step `first`: steps that neither move the tool nor
/// stop it do not end a chain.
std::size_t end_of_chain(const Toolpath& path, std::size_t first);
/// Appends a cut that starts at `from`, seen from above; an arc as its two halves.
void add_segment(Outline& outline, const Step& s, Point3 from);

/// The vertex of an outline to which its last segment returns: the start, or the end of a lead-in.
std::optional<std::size_t> loop_start(const Outline& outline);
/// The part of an outline from that vertex on, closed.
Outline loop_from(const Outline& outline, std::size_t vertex);

/// A chain that goes straight down and then around a closed path on one level.
struct LoopChain {
  std::size_t first = 0, level = 0, end = 0;  // steps: the first, the first on the level, one past the last
  Point3 start;                               // of the tool before the first
  double bottom = 0.0;                        // Z of the level
  Feed plunge{}, feed{};
  Outline outline;    // of the closed path
  bool plain = true;  // once around; else with a lead-in, or more after the closed path
};
std::vector<LoopChain> loop_chains(const Toolpath& path);
/// The paths of chains as walls that another path of the same axis must not cross.
Walls walls_of(const std::vector<LoopChain>& chains);

}  // namespace kerf::op_detail
