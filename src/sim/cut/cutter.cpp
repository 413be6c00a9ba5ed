// Prepares the jobs of the kernels and merges their contacts.
#include "sim/cut/cutter.h"

#include <algorithm>

namespace kerf::sim {

void Cutter::AxisColumns::add(double column_fraction, double column_position, int number, double pitch) {
  const int first = number / kTileColumns * kTileColumns;
  fraction.push_back(static_cast<Real>(column_fraction));
  position.push_back(static_cast<Real>(column_position - (first + 0.5) * pitch));
}

Cutter::Cutter(Workpiece::Body& body, const std::vector<ToolSolids>& tools, Length hazard_depth)
    : body_(body) {
  for (const ToolSolids& solids : tools) tools_.emplace_back(solids);
  constexpr double kNarrower = 1e-6;  // less comes from rounding
  narrow_x_ = body_.fraction_x(body_.nx - 1) < 1.0 - kNarrower;
  narrow_y_ = body_.fraction_y(body_.ny - 1) < 1.0 - kNarrower;
  field_.pitch = body_.pitch;
  field_.height = body_.height;
  field_.same_height = body_.same_height;
  field_.hazard_depth = static_cast<Real>(hazard_depth.mm());
  for (int i = 0; i < kTileColumns; ++i) field_.step[i] = static_cast<Real>(i * body_.pitch);
  for (int i = 0; i < body_.tiles_x * kTileColumns; ++i)
    along_x_.add(body_.fraction_x(i), body_.column_x(std::min(i, body_.nx - 1)), i, body_.pitch);
  for (int j = 0; j < body_.tiles_y * kTileColumns; ++j)
    along_y_.add(body_.fraction_y(j), body_.column_y(std::min(j, body_.ny - 1)), j, body_.pitch);
}

/// Sets the positions of the columns of a tile in a job.
void Cutter::set_columns(std::size_t tile, TileJob& job) const {
  const auto tiles_x = static_cast<std::size_t>(body_.tiles_x);
  const auto column = static_cast<int>(tile % tiles_x) * kTileColumns;
  const auto row = static_cast<int>(tile / tiles_x) * kTileColumns;
  job.field = &field_;
  job.x = (column + 0.5) * body_.pitch;
  job.y = (row + 0.5) * body_.pitch;
  if ((narrow_x_ && column + kTileColumns >= body_.nx) || (narrow_y_ && row + kTileColumns >= body_.ny)) {
    job.position_x = along_x_.position.data() + column;
    job.position_y = along_y_.position.data() + row;
    job.fraction_x = along_x_.fraction.data() + column;
    job.fraction_y = along_y_.fraction.data() + row;
  }
}

TileColumns Cutter::columns_of(std::size_t tile) const {
  TileJob job;
  set_columns(tile, job);
  TileColumns columns;
  for (int i = 0; i < kTileColumns; ++i) {
    columns.x[i] = job.position_x != nullptr ? job.position_x[i] : even_position(field_, i);
    columns.y[i] = job.position_y != nullptr ? job.position_y[i] : even_position(field_, i);
    columns.fraction_x[i] = job.fraction_x != nullptr ? job.fraction_x[i] : 1.0f;
    columns.fraction_y[i] = job.fraction_y != nullptr ? job.fraction_y[i] : 1.0f;
  }
  return columns;
}

TileJob Cutter::job(CutBatch& batch, std::size_t k) const {
  const Batch& plan = *batch.plan;
  TileJob job;
  set_columns(plan.busy[k], job);
  job.tools = &tools_;
  job.sweeps = plan.sweeps.data();
  job.list = plan.list.data() + plan.start[k];
  job.count = plan.start[k + 1] - plan.start[k];
  job.removed = batch.removed.data() + plan.start[k];
  job.contacts = &batch.contacts_of[k];
  return job;
}

void ContactList::add(const Contact& contact) {
  const auto [it, is_new] = contacts_.try_emplace({contact.step, contact.kind}, contact);
  if (is_new) return;
  Contact& all = it->second;
  if (contact.fraction < all.fraction) {
    all.fraction = contact.fraction;
    all.at = contact.at;
  }
  all.depth = std::max(all.depth, contact.depth);
  all.removed += contact.removed;
}

std::vector<Hazard> ContactList::hazards(Point3 low) const {
  std::vector<Hazard> list;
  for (const auto& [key, contact] : contacts_)
    list.push_back({key.second, key.first, contact.at + low, mm(contact.depth), mm3(contact.removed)});
  return list;
}

}  // namespace kerf::sim
