// Random programs with every kind of step, tool and stock.
#pragma once

#include <cstdint>
#include <random>

#include "kerf/job/program_file.h"

namespace kerf {

class RandomProgram {
 public:
  explicit RandomProgram(std::uint32_t seed) : random_(seed) {}
  Program make();

 private:
  double number(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
  int whole(int low, int high) { return std::uniform_int_distribution<>(low, high)(random_); }
  bool chance(double p) { return number(0, 1) < p; }
  unsigned axes() { return static_cast<unsigned>(whole(0, 7)); }
  Point3 point();
  std::string word();
  template <class E>
  E one_of(E last) {
    return static_cast<E>(whole(0, static_cast<int>(last)));
  }

  OriginId origin(OriginTable& table);
  void add_motion(Toolpath& path);
  void decorate(Toolpath& path, std::size_t i);
  void add_machine_step(Toolpath& path, OriginId at);
  void add_zero(Toolpath& path, OriginId at);
  void add_text(Toolpath& path, OriginId at);
  Tool tool(int number);
  Stock stock();

  std::mt19937 random_;
};

}  // namespace kerf
