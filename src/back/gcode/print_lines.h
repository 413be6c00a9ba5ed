// Printers: beads with their comments, extruders, heaters, fans, limits of motions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "back/gcode/axis_words.h"
#include "back/gcode/file_texts.h"
#include "back/gcode/modal_words.h"
#include "back/gcode/post_part.h"
#include "path/firmware_retraction.h"

namespace kerf::gcode {

/// The limits of a printer's motions.
class LimitLines : PostPart {
 public:
  explicit LimitLines(PostContext& context) : PostPart(context) {}

  void motion_limits(std::size_t i);

 private:
  void put_limits(std::size_t i, const step::MotionLimits& limits, std::string_view letters, double factor);
  void put_klipper_limit(std::size_t i, const step::MotionLimits& limits);
  void skip_limits(std::size_t i, LimitKind kind);

  unsigned skipped_ = 0;  // one bit per LimitKind that was reported
};

class PrintLines : PostPart {
 public:
  PrintLines(PostContext& context, AxisWords& axes, ModalWords& words, const Filament& filament,
             FileTexts& texts)
      : PostPart(context), axes_(axes), words_(words), filament_(filament), texts_(texts) {}

  void extrude(std::size_t i);
  /// Lines such as G10 and M207, in the form of the target, or as E words.
  void firmware_retraction(std::size_t i, const FirmwareRetraction& retraction);
  /// A motion was written: whether it laid a bead.
  void note_motion(bool on_bead) { on_bead_ = on_bead; }
  void select_extruder(std::size_t i);
  void temperature(std::size_t i);
  void fan(std::size_t i);
  void start_file();

 private:
  void comment_on_bead(std::size_t i, const step::Extrude& bead);
  /// Pushes filament, mm3, where the nozzle is.
  void push(std::size_t i, double volume, Feed feed);
  double in_e_words(double volume) const;
  void put_lengths(std::size_t i, const RetractionLengths& lengths);

  AxisWords& axes_;
  ModalWords& words_;
  const Filament& filament_;
  FileTexts& texts_;
  double extruded_ = 0.0;              // mm of filament, or mm3
  std::int64_t written_extruded_ = 0;  // in counts of E
  std::optional<double> layer_z_;      // of the last layer in comments, mm
  std::optional<BeadKind> commented_kind_;
  double commented_width_ = 0.0, commented_height_ = 0.0;  // mm
  RetractionLengths lengths_;                              // of the firmware, as the program has set them
  double drawn_back_ = 0.0;                                // by E words for the firmware, mm3
  bool on_bead_ = false;                                   // the last motion laid a bead
};

}  // namespace kerf::gcode
