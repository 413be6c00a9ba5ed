// Blocks end where the numbers of a motion say so, not after a fixed count: after an edit the same ends are
// found again.
#include "app/shown/block_maker.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

namespace kerf::app::view {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr std::size_t kShortest = 512, kLongest = 8192;  // motions of a block
constexpr std::uint32_t kEnds = 1023;                    // one of so many motions ends a block
constexpr std::size_t kMaxPoints = 65'536;               // of arcs; then the block ends
constexpr std::size_t kMaxOrigins = 32'768;              // of deep calls
constexpr std::size_t kKnown = 1024;                     // locations that are found again; a power of 2
constexpr std::uint8_t kJoined = 8;                      // added to the kind

std::uint32_t mixed(std::uint32_t a, std::uint32_t b) {
  std::uint32_t h = (a ^ (b + 0x9e3779b9u + (a << 6) + (a >> 2))) * 0x85ebca6bu;
  h ^= h >> 13;
  return h * 0xc2b2ae35u ^ h >> 16;
}

/// The same bits. libc++ 13 has no std::bit_cast.
template <class To, class From>
To with_bits_of(From value) {
  static_assert(sizeof(To) == sizeof(From));
  To bits{};
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

template <class Small>
std::vector<Small> narrowed(const std::vector<std::uint32_t>& values) {
  std::vector<Small> out(values.size());
  std::transform(values.begin(), values.end(), out.begin(), [](auto v) { return static_cast<Small>(v); });
  return out;
}

}  // namespace

void Column::add(float value) { values_.push_back(with_bits_of<std::uint32_t>(value)); }

void Column::add_difference(std::int64_t difference) {
  const auto twice = static_cast<std::uint32_t>(difference) << 1;
  values_.push_back(difference < 0 ? ~twice : twice);
}

void Column::write(BinaryWriter& out) const {
  std::uint32_t low = kNone, high = 0;
  for (const std::uint32_t value : values_) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (values_.empty() || low == high) {
    out.number(0);
    out.number(high);
  } else if (high <= 0xff) {
    out.number(1);
    out.array(narrowed<std::uint8_t>(values_));
  } else if (high <= 0xffff) {
    out.number(2);
    out.array(narrowed<std::uint16_t>(values_));
  } else {
    out.number(4);
    out.array(values_);
  }
}

BlockOrigins::BlockOrigins(const OriginTable& table, const std::vector<std::string>& names)
    : table_(table), last_file_(kNone), known_(kKnown) {
  for (std::size_t k = 0; k < names.size(); ++k) file_[names[k]] = static_cast<std::uint32_t>(k);
}

std::uint32_t BlockOrigins::number(OriginId id) {
  if (has_last_ && id == last_id_) return last_;
  has_last_ = true;
  last_id_ = id;
  std::uint32_t caller = kNone, depth = 0;
  if (id != OriginId::none) {
    const std::vector<Origin> calls = table_.callers(id);
    for (auto call = calls.rbegin(); call != calls.rend(); ++call) caller = add(*call, caller, depth++);
  }
  last_ = add(table_.resolve(id), caller, depth);
  return last_;
}

std::uint32_t BlockOrigins::add(const Origin& origin, std::uint32_t caller, std::uint32_t depth) {
  std::uint32_t file = kNone, line = 0;
  if (const auto* text = std::get_if<TextLocation>(&origin)) {
    file = file_number(text->file);
    line = text->line;
  } else if (const auto* call = std::get_if<CallLocation>(&origin)) {
    file = file_number(call->file);
    line = call->line;
  } else if (const auto* drawing = std::get_if<DrawingLocation>(&origin)) {
    file = file_number(drawing->file);
  }
  const std::uint32_t group = group_of(file, depth, line);
  Group& own = groups_[group];
  const std::uint32_t relative = line - own.first_line;
  Known& known = known_[mixed(mixed(relative, group), caller) & (kKnown - 1)];
  if (known.is_used && known.group == group && known.line == relative && known.caller == caller)
    return known.number;
  known = {group, relative, caller, count_, true};
  group_.add(group);
  line_.add_difference(line - own.last_line);
  caller_.add(caller + 1);  // 0: none
  own.last_line = line;
  return count_++;
}

std::uint32_t BlockOrigins::group_of(std::uint32_t file, std::uint32_t depth, std::uint32_t line) {
  for (std::size_t k = 0; k < groups_.size(); ++k)
    if (groups_[k].file == file && groups_[k].depth == depth) return static_cast<std::uint32_t>(k);
  groups_.push_back({file, depth, line, std::int64_t{line} - 1});  // so that lines one by one differ alike
  return static_cast<std::uint32_t>(groups_.size() - 1);
}

std::uint32_t BlockOrigins::file_number(const std::string& name) {
  if (name == last_name_) return last_file_;
  const auto known = file_.find(name);
  last_name_ = name;
  last_file_ = known == file_.end() ? kNone : known->second;
  return last_file_;
}

void BlockOrigins::write(BinaryWriter& out) const {
  for (const Group& group : groups_) out.number(group.file);
  group_.write(out);
  line_.write(out);
  caller_.write(out);
}

std::vector<std::uint32_t> BlockOrigins::take_lines() {
  std::vector<std::uint32_t> lines;
  for (const Group& group : groups_) lines.push_back(group.first_line);
  return lines;
}

void BlockOrigins::clear() {
  groups_.clear();
  std::fill(known_.begin(), known_.end(), Known{});
  for (Column* column : {&group_, &line_, &caller_}) column->clear();
  count_ = 0;
  has_last_ = false;
}

BlockMaker::BlockMaker(const OriginTable& table, const std::vector<std::string>& names)
    : origins_(table, names) {}

/// The number of points that are added: without the start where the motion before has ended there.
std::uint32_t BlockMaker::add_points(const std::vector<Point3>& points, bool& is_joined) {
  const std::size_t before = points_.size();
  for (const Point3& p : points)
    for (const double v : {p.x, p.y, p.z}) points_.push_back(static_cast<float>(v));
  const auto first = points_.begin() + static_cast<std::ptrdiff_t>(before);
  is_joined = before != 0 && points_.size() != before && std::equal(first - 3, first, first);
  if (is_joined) points_.erase(first, first + 3);
  return static_cast<std::uint32_t>((points_.size() - before) / 3);
}

void BlockMaker::add(const ShownMotion& motion, const std::vector<Point3>& points) {
  if (is_full_) end_block();
  if (count_.size() == 0) first_step_ = motion.step;
  step_.add(motion.step - first_step_ - static_cast<std::uint32_t>(step_.size()));
  bool is_joined = false;
  count_.add(add_points(points, is_joined));
  kind_.add(static_cast<std::uint32_t>(is_joined ? motion.kind + kJoined : motion.kind));
  tool_.add(static_cast<std::uint32_t>(motion.tool) + 1u);
  const std::uint32_t origin = origins_.number(motion.origin);
  origin_.add_difference(static_cast<std::int64_t>(origin) - last_origin_);
  last_origin_ = origin;
  seconds_.add(motion.seconds);
  feed_.add(motion.feed);
  flow_.add(motion.flow);
  power_.add(motion.power);
  bead_.add(std::uint32_t{motion.bead});
  std::uint32_t hash = motion.kind;
  for (std::size_t k = points_.size() - std::min<std::size_t>(points_.size(), 3); k < points_.size(); ++k)
    hash = mixed(hash, with_bits_of<std::uint32_t>(points_[k]));
  is_full_ = (count_.size() >= kShortest && (hash & kEnds) == 0) || count_.size() >= kLongest ||
             points_.size() >= 3 * kMaxPoints || origins_.size() >= kMaxOrigins;
}

void BlockMaker::add_seconds(float more) {
  if (seconds_.size() == 0) return;
  std::uint32_t& last = seconds_.back();
  last = with_bits_of<std::uint32_t>(with_bits_of<float>(last) + more);
}

void BlockMaker::end_block() {
  BinaryWriter out;
  out.reserve(12 * count_.size() + 4 * points_.size());
  const auto columns = {&step_,    &count_, &kind_, &tool_,  &origin_,
                        &seconds_, &feed_,  &flow_, &power_, &bead_};
  for (const Column* column : columns) column->write(out);
  origins_.write(out);
  out.array(points_);
  made_.push_back({out.take(), static_cast<std::uint32_t>(count_.size()),
                   static_cast<std::uint32_t>(points_.size() / 3),
                   static_cast<std::uint32_t>(origins_.size()), first_step_, origins_.take_lines()});
  for (Column* column : columns) column->clear();
  origins_.clear();
  points_.clear();
  last_origin_ = -1;
  is_full_ = false;
}

PathBlocks BlockMaker::finish(const PathBlocks& before, std::uint32_t revision) {
  if (count_.size() != 0) end_block();
  PathBlocks out;
  out.revision_ = revision;
  out.ids_ = before.ids_;
  std::unordered_map<std::string_view, PathBlock> known;  // of the path before, and of this one
  known.reserve(before.blocks_.size());
  for (const PlacedBlock& placed : before.blocks_) known.try_emplace(*placed.block.bytes, placed.block);
  for (Made& made : made_) {
    auto found = known.find(made.bytes);
    if (found == known.end()) {
      auto bytes = std::make_shared<const std::string>(std::move(made.bytes));
      const PathBlock block{++out.ids_, revision, made.motions, made.points, made.origins, bytes};
      found = known.emplace(*block.bytes, block).first;
    }
    out.blocks_.push_back({found->second, made.first_step, std::move(made.lines)});
  }
  made_.clear();
  return out;
}

}  // namespace kerf::app::view
