// The keys of printers and filaments: one table for reading and writing.
#pragma once

#include <string_view>
#include <vector>

#include "kerf/formats/printer_files.h"

namespace kerf::detail {

template <class Profile>
struct NumberKey {
  std::string_view name, unit;
  std::size_t count = 1;
  double low = 0.0, high = 0.0;  ///< of each number
  void (*set)(Profile&, const double*) = nullptr;
  std::vector<double> (*get)(const Profile&) = nullptr;  ///< empty: not stated
};
const std::vector<NumberKey<PrinterProfile>>& printer_numbers();
const std::vector<NumberKey<FilamentProfile>>& filament_numbers();

}  // namespace kerf::detail
