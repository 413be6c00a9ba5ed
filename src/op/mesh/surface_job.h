// What operations on meshes have in common: their options with defaults, the tool, and its contact with the
// mesh.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string_view>
#include <thread>

#include "op/mesh/surface_path.h"

namespace kerf::op_detail {

struct SurfaceJob {
  SurfaceJob(const SurfaceMesh& mesh, const SurfaceTool& tool, const MeshCutOptions& options, double lowest);
  SurfaceJob(const SurfaceJob&) = delete;  // its parts refer to each other
  SurfaceJob& operator=(const SurfaceJob&) = delete;

  CutOptions cut;  ///< with the depth down to `floor`
  double floor;    ///< Z of the tip
  DropCutter cutter;
  SurfaceFollower follower;  ///< of the tool with its allowance

  /// The path of the tip along a line.
  std::vector<Point3> follow(Point2 from, Point2 to) const;
};

/// How deep the tip may go.
enum class SurfaceFloor : bool {
  limited,  ///< down to the depth, or the lowest point of the mesh
  none      ///< as deep as the mesh is, and off the mesh much deeper
};
/// Nothing, with errors, for options out of range, and for meshes and tools that cannot be used. That of a
/// stopped run is not usable.
std::optional<SurfaceJob> surface_job(const SurfaceMesh& mesh, const Tool& tool,
                                      const MeshCutOptions& options, SurfaceFloor floor,
                                      Diagnostics& diagnostics);

/// Asks within long items whether to stop. Progress is called from one thread only: the others see the answer
/// that it got.
class LineStop {
 public:
  explicit LineStop(Progress* progress) : progress_(progress), caller_(std::this_thread::get_id()) {}
  bool operator()() const {
    if (std::this_thread::get_id() == caller_ && stop_requested(progress_)) stopped_ = true;
    return stopped_;
  }

 private:
  Progress* progress_;
  std::thread::id caller_;
  mutable std::atomic<bool> stopped_{false};
};

/// Calls make(i, stop) for each i below `count`, on several threads, as a phase of the work. False where it
/// was stopped.
bool for_each_line(const MeshCutOptions& options, std::string_view phase, std::size_t count,
                   const std::function<void(std::size_t, const LineStop&)>& make);

}  // namespace kerf::op_detail
