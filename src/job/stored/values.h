// How single values are stored: one function per type, for a sink and for a source.
//
// value(a, v) writes v to a sink or reads it from a source; values(a, x, y, ...) several of them. A structure
// names its members by a structured binding, so that a new one does not compile before it is stored, too.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "job/stored/bytes.h"

#include "kerf/base/units.h"
#include "kerf/geom/geometry.h"

namespace kerf::stored {

// ---- numbers and texts. Numbers are finite.

inline void value(Sink& a, const double& v) { a.number(v); }
inline void value(Source& a, double& v) {
  v = a.number();
  if (!std::isfinite(v)) a.refuse("a number is not finite");
}
inline void value(Sink& a, const bool& v) { a.byte(v ? 1 : 0); }
inline void value(Source& a, bool& v) {
  const std::uint8_t read = a.byte();
  if (read > 1) a.refuse("a flag is neither 0 nor 1");
  v = read == 1;
}
template <class T>
concept Whole = std::is_integral_v<T> && !std::is_same_v<T, bool>;
template <Whole T>
void value(Sink& a, const T& v) {
  a.signed_whole(static_cast<std::int64_t>(v));
}
template <Whole T>
void value(Source& a, T& v) {
  static_assert(sizeof(T) <= 4);
  const std::int64_t read = a.signed_whole();
  if (read < std::int64_t{std::numeric_limits<T>::min()} ||
      read > std::int64_t{std::numeric_limits<T>::max()})
    a.refuse("an integer is out of range");
  else
    v = static_cast<T>(read);
}
inline void value(Sink& a, const std::string& v) { a.text(v); }
inline void value(Source& a, std::string& v) { v = a.text(); }

/// The last enumerator of each stored enumeration.
template <class E>
inline constexpr E kLast = E::unspecified;

template <class E>
requires std::is_enum_v<E>
void value(Sink& a, const E& v) {
  static_assert(static_cast<int>(kLast<E>) < 256);
  a.byte(static_cast<std::uint8_t>(v));
}
template <class E>
requires std::is_enum_v<E>
void value(Source& a, E& v) {
  const std::uint8_t read = a.byte();
  if (read > static_cast<std::uint8_t>(kLast<E>))
    a.refuse("a choice is unknown");
  else
    v = static_cast<E>(read);
}

template <int L, int T>
void value(Sink& a, const Quantity<L, T>& v) {
  a.number(v.raw());
}
template <int L, int T>
void value(Source& a, Quantity<L, T>& v) {
  double raw = 0.0;
  value(a, raw);
  v = Quantity<L, T>::raw(raw);
}
inline void value(Sink& a, const Angle& v) { a.number(v.rad()); }
inline void value(Source& a, Angle& v) {
  double rad = 0.0;
  value(a, rad);
  v = radians(rad);
}

// ---- containers

template <class T>
void value(Sink& a, const std::optional<T>& v) {
  value(a, v.has_value());
  if (v) value(a, *v);
}
template <class T>
void value(Source& a, std::optional<T>& v) {
  bool has = false;
  value(a, has);
  v.reset();
  if (has) value(a, v.emplace());
}
template <class A, class T, std::size_t N>
void value(A& a, std::array<T, N>& v) {
  for (auto& entry : v) value(a, entry);
}
template <class T, std::size_t N>
void value(Sink& a, const std::array<T, N>& v) {
  for (const auto& entry : v) value(a, entry);
}
template <class T>
void value(Sink& a, const std::vector<T>& v) {
  a.whole(v.size());
  for (const T& entry : v) value(a, entry);
}
template <class T>
void value(Source& a, std::vector<T>& v) {
  constexpr std::size_t kMinBytes = std::is_same_v<T, double> ? 8 : 1;
  v.clear();
  for (std::size_t left = a.entries(kMinBytes); left > 0 && !a.failed(); --left) value(a, v.emplace_back());
}
template <class T>
void value(Sink& a, const std::map<int, T>& v) {
  a.whole(v.size());
  for (const auto& [key, entry] : v) {
    value(a, key);
    value(a, entry);
  }
}
template <class T>
void value(Source& a, std::map<int, T>& v) {
  v.clear();
  for (std::size_t left = a.entries(2); left > 0 && !a.failed(); --left) {
    int key = 0;
    value(a, key);
    if (!v.empty() && key <= v.rbegin()->first) a.refuse("numbers are out of order");
    value(a, v[key]);
  }
}

template <class A, class... T>
void values(A& a, T&&... v) {
  (value(a, v), ...);
}

// ---- points

inline void value(Sink& a, const Point3& v) { values(a, v.x, v.y, v.z); }
inline void value(Source& a, Point3& v) { values(a, v.x, v.y, v.z); }
inline void value(Sink& a, const Box3& v) {
  value(a, v.empty());
  if (!v.empty()) values(a, v.low, v.high);
}
inline void value(Source& a, Box3& v) {
  bool empty = true;
  value(a, empty);
  v = {};
  if (empty) return;
  values(a, v.low, v.high);
  if (v.empty()) a.refuse("a box has no inside");
}

}  // namespace kerf::stored
