// Steps of a compiled path.
#include "front/pathdxf/compile/emitter.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/names.h"
#include "base/number.h"
#include "front/pathdxf/text/nearly.h"

namespace kerf::pathdxf {
namespace {

constexpr unsigned kX = 1, kY = 2, kZ = 4;  // bits of axes, see Step::named_axes
constexpr double kTimeFactor = 1.4;         // of the statistics: acceleration and the like
constexpr std::size_t kProbesPerPoint = 4;  // that correct a height
constexpr double kProbeDistance = 0.001;    // mm, added to distances so that weights stay finite

/// Text of a comment: neither parentheses nor backslashes end it.
std::string comment_text(std::string_view text) {
  std::string out(trim(text));
  for (char& c : out) {
    if (c == ')') c = ']';
    if (c == '\\') c = '/';
    if (c == '\n' || c == '\r') c = ' ';
  }
  return out;
}

}  // namespace

std::string number_text3(double value) {
  std::string out;
  append_fixed(out, value, 3, MinusZero::keep);
  return out;
}

std::string point_text3(Point3 p) {
  return fmt::format("[{} {} {}]", number_text3(p.x), number_text3(p.y), number_text3(p.z));
}

Emitter::Emitter(Toolpath& path, const PathdxfOptions& options, const std::vector<PlacedProbe>& probes,
                 double feed)
    : path_(path),
      options_(options),
      probes_(probes),
      modal_feed_(kDefaultPathdxfFeed.mm_per_min()),
      sweep_speed_(options.rapid_speed.value_or(mm_per_min(feed)).mm_per_min()) {}

bool Emitter::full() const { return path_.size() >= options_.max_steps; }

void Emitter::add_comment(std::string text, OriginId origin) {
  if (waiting_)
    waiting_->comments.emplace_back(std::move(text), origin);
  else
    path_.add(step::Note{std::move(text)}, origin);
}

void Emitter::comment(int indent, std::string_view text) {
  add_comment(std::string(static_cast<std::size_t>(traces() ? indent : 0), ' ') + comment_text(text),
              origin_);
}

void Emitter::trace(int indent, std::string_view text) {
  if (traces()) comment(indent, text);
}

void Emitter::count_sweep(double length) {
  statistics_.sweeps += length;
  statistics_.sweep_time += kTimeFactor * length / sweep_speed_;
  ++statistics_.commands;
}

std::size_t Emitter::add_rapid(Point3 to, unsigned named_axes) {
  const std::size_t i = path_.add(step::Rapid{to}, origin_);
  path_.set_named_axes(i, named_axes);
  return i;
}

void Emitter::flush() {
  if (!waiting_) return;
  const Waiting w = std::move(*waiting_);
  waiting_.reset();
  const std::size_t i = path_.add(step::Rapid{{w.to.x, w.to.y, w.z}}, w.origin);
  path_.set_named_axes(i, kX | kY);
  count_sweep(w.length);
  for (const auto& [text, origin] : w.comments) path_.add(step::Note{text}, origin);
}

void Emitter::rapid_xy(Point2 to, double length, bool mergeable) {
  if (waiting_ && waiting_->mergeable && mergeable) {
    const Waiting w = std::move(*waiting_);
    waiting_.reset();
    if (traces())
      path_.add(step::Note{fmt::format("; G00 X{} Y{}", number_text3(w.to.x), number_text3(w.to.y))},
                w.origin);
    for (const auto& [text, origin] : w.comments) path_.add(step::Note{text}, origin);
  }
  flush();
  position_ = {to.x, to.y, position_.z};
  waiting_ = Waiting{to, position_.z, length, mergeable, origin_, {}};
}

void Emitter::rapid_z(double z, Point2 at, double length) {
  flush();
  count_sweep(length);
  position_.z = z;
  correct(add_rapid(position_, kZ), z, at);
}

void Emitter::last_rapid(double z) {
  flush();
  count_sweep(std::abs(z - position_.z));
  position_.z = z;
  add_rapid(position_, kZ);
}

void Emitter::plunge(double z, Point2 at, double length, double feed) {
  flush();
  position_.z = z;
  const std::size_t i = path_.add(step::Cut{position_, mm_per_min(modal_feed_)}, origin_);
  path_.set_named_axes(i, kZ);
  correct(i, z, at);
  statistics_.drilling += length;
  statistics_.drilling_time += kTimeFactor * length / feed;
  ++statistics_.commands;
}

void Emitter::cut(Point3 to, double feed, double length, Point2 at) {
  flush();
  modal_feed_ = feed;
  position_ = to;
  const std::size_t i = path_.add(step::Cut{to, mm_per_min(feed)}, origin_);
  path_.set_named_axes(i, kX | kY | kZ);
  correct(i, to.z, at);
  statistics_.milling += length;
  statistics_.milling_time += kTimeFactor * length / feed;
  ++statistics_.commands;
}

void Emitter::arc(Point3 to, Point2 centre, Turn turn, double feed, double length, Point2 at) {
  flush();
  modal_feed_ = feed;
  position_ = to;
  step::Arc arc;
  arc.to = to;
  arc.centre = centre;
  arc.turn = turn;
  arc.feed = mm_per_min(feed);
  const std::size_t i = path_.add(arc, origin_);
  path_.set_named_axes(i, kX | kY | kZ);
  correct(i, to.z, at);
  statistics_.milling += length;
  statistics_.milling_time += kTimeFactor * length / feed;
  ++statistics_.commands;
}

/// The height as an expression of the nearest probes, weighted by their distances.
void Emitter::correct(std::size_t step, double z, Point2 at) {
  if (probes_.empty()) return;
  std::vector<std::pair<double, std::size_t>> weights;  // negative, so that the largest come first
  for (std::size_t i = 0; i < probes_.size(); ++i)
    weights.emplace_back(-1.0 / (distance(probes_[i].at, at) + kProbeDistance), i);
  const std::size_t used = std::min(kProbesPerPoint, weights.size());
  std::partial_sort(weights.begin(), weights.begin() + static_cast<std::ptrdiff_t>(used), weights.end());
  double sum = 0.0;
  for (std::size_t i = 0; i < used; ++i) sum += weights[i].first;
  std::string text = number_text3(z);
  for (std::size_t i = 0; i < used; ++i) {
    const PlacedProbe& probe = probes_[weights[i].second];
    text += fmt::format("+{}*[{}-{}]", number_text3(weights[i].first / sum), probe.name,
                        number_text3(probe.thickness));
  }
  MotionExtra extra;
  extra.z_correction = std::move(text);
  path_.set_extra(step, std::move(extra));
}

}  // namespace kerf::pathdxf
