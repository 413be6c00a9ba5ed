// The words in force in the controller.
#include "back/gcode/modal_words.h"

#include <algorithm>
#include <cmath>

#include "back/gcode/file_texts.h"
#include "base/codes/gcode.h"

namespace kerf::gcode {
namespace {

constexpr int kInverseDecimals = 6;   // of F in G93, 1/min: a cut of 100 minutes keeps four digits
constexpr double kMaxInverse = 1e12;  // counts of it: 1,000,000 per minute, 60 us

}  // namespace

void ModalWords::put_motion(int g) {
  const bool in_force = g == motion_ && profile_.syntax == LineSyntax::words;
  if (in_force && profile_.motion == Repeat::when_changed) return;
  lines_.code('G', g * 10);
  motion_ = g;
}

/// Adds the plane of an arc, on a separate line for LineSyntax::commands.
void ModalWords::put_plane(std::size_t i, Plane plane) {
  if (plane_ == plane) return;
  plane_ = plane;
  if (plane == Plane::xy && !profile_.has_g(170)) return;  // the only plane of the controller
  lines_.code('G', plane == Plane::xy ? 170 : plane == Plane::xz ? 180 : 190);
  if (profile_.syntax == LineSyntax::words) return;
  lines_.end_line(i);
  lines_.start_line();
}

void ModalWords::put_feed(std::size_t i) {
  Feed feed = path_[i].feed();
  if (!(feed.raw() > 0.0)) feed = options_.missing_feed;
  if (!(feed.raw() > 0.0)) {
    if (!no_feed_reported_)
      diagnostics_.error(codes::post_no_feed, path_.origin_of(i), "a cut without a feed").hint =
          "specify a feed for such cuts with --feed";
    no_feed_reported_ = true;
    return;
  }
  put_feed(feed, rotary_.only_turns(i) ? std::pow(10.0, profile_.decimals.feed) : units_.counts_per_feed);
}

void ModalWords::put_feed(Feed feed) { put_feed(feed, units_.counts_per_feed); }

void ModalWords::put_inverse_mode() {
  if (!inverse_time_) lines_.code('G', 930);
  inverse_time_ = true;
}

void ModalWords::put_inverse_time(Duration time) {
  const double counts = std::pow(10.0, kInverseDecimals) / time.minutes();
  lines_.word('F', std::max<std::int64_t>(1, std::llround(std::min(counts, kMaxInverse))), kInverseDecimals);
}

void ModalWords::end_inverse_time(std::size_t i) {
  if (!inverse_time_) return;
  inverse_time_ = false;
  feed_ = -1;
  lines_.start_line();
  lines_.code('G', 940);
  lines_.end_line(i);
}

void ModalWords::put_feed(Feed feed, double scale) {
  if (inverse_time_) lines_.code('G', 940), inverse_time_ = false, feed_ = -1;
  const auto counts = std::max<std::int64_t>(1, std::llround(feed.mm_per_min() * scale));
  if (counts == feed_ && profile_.feed == Repeat::when_changed) return;
  feed_ = counts;
  lines_.word('F', counts, profile_.decimals.feed);
}

void ModalWords::put_power() {
  if (!pending_power_) return;
  lines_.word('S', std::llround(*pending_power_ * std::pow(10.0, profile_.decimals.speed)),
              profile_.decimals.speed);
  pending_power_.reset();
}

void ModalWords::raw_line(std::string_view text) {
  lines_.text_line(text);
  if (!is_comment(text)) forget();
}

void ModalWords::forget() {
  axes_.lose(kAllAxes);
  rotary_.lose(kAllAxes);
  motion_ = -1;
  plane_.reset();
  feed_ = -1;
}

}  // namespace kerf::gcode
