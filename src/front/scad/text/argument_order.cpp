// The order of a hash table, without the table: results are the same with every standard library.
#include "front/scad/text/argument_order.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace kerf::scad {
namespace {

/// MurmurHash64A with the seed of libstdc++'s std::hash.
std::uint64_t hash_of(std::string_view text) {
  constexpr std::uint64_t kFactor = 0xc6a4a7935bd1e995u, kSeed = 0xc70f6907u;
  constexpr std::size_t kWord = 8;
  constexpr int kShift = 47;
  const auto mix = [](std::uint64_t x) { return x ^ (x >> kShift); };
  std::uint64_t hash = kSeed ^ (text.size() * kFactor);
  for (std::size_t i = 0; i < text.size(); i += kWord) {
    const std::string_view bytes = text.substr(i, kWord);
    std::uint64_t word = 0;
    for (std::size_t k = bytes.size(); k-- > 0;) word = word << 8 | static_cast<unsigned char>(bytes[k]);
    if (bytes.size() == kWord) word = mix(word * kFactor) * kFactor;
    hash = (hash ^ word) * kFactor;
  }
  return mix(mix(hash) * kFactor);
}

}  // namespace

std::vector<std::size_t> table_order(const std::vector<std::string_view>& names) {
  constexpr std::array<std::uint64_t, 6> kBuckets{13, 29, 59, 127, 257, 541};  // grows when it is full
  std::size_t size = 0;
  std::vector<std::uint64_t> hashes;
  for (const std::string_view name : names) hashes.push_back(hash_of(name));
  std::vector<std::size_t> order;
  // Before the entries of its bucket, or before all if there are none.
  const auto insert = [&](std::size_t i) {
    const auto same = [&](std::size_t k) { return hashes[k] % kBuckets[size] == hashes[i] % kBuckets[size]; };
    const auto found = std::find_if(order.begin(), order.end(), same);
    order.insert(found == order.end() ? order.begin() : found, i);
  };
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i == kBuckets[size] && size + 1 < kBuckets.size()) {
      ++size;
      const std::vector<std::size_t> before = std::exchange(order, {});
      for (const std::size_t k : before) insert(k);
    }
    insert(i);
  }
  return order;
}

std::vector<Taken> taken_of(const std::vector<std::string_view>& parameters, std::size_t positional,
                            const std::vector<Argument>& arguments) {
  std::vector<std::string_view> names;
  std::vector<Taken> all;
  std::size_t position = 0;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    std::string_view name = arguments[i].name;
    if (name.empty() && position == positional) continue;
    if (name.empty()) name = parameters[position++];
    const auto p = std::find(parameters.begin(), parameters.end(), name);
    const Taken taken{static_cast<std::uint32_t>(i),
                      p == parameters.end() ? -1 : static_cast<std::int32_t>(p - parameters.begin())};
    const auto known = std::find(names.begin(), names.end(), name);
    if (known != names.end()) {
      all[static_cast<std::size_t>(known - names.begin())] = taken;  // the last one counts
      continue;
    }
    names.push_back(name);
    all.push_back(taken);
  }
  std::vector<Taken> out;
  for (const std::size_t i : table_order(names)) out.push_back(all[i]);
  return out;
}
std::vector<Taken> taken_of(const std::vector<Parameter>& parameters,
                            const std::vector<Argument>& arguments) {
  std::vector<std::string_view> names;
  for (const Parameter& p : parameters) names.emplace_back(p.name);
  return taken_of(names, declared_count(parameters), arguments);
}
std::size_t declared_count(const std::vector<Parameter>& parameters) {
  return static_cast<std::size_t>(
      std::count_if(parameters.begin(), parameters.end(), [](const Parameter& p) { return !p.undeclared; }));
}

}  // namespace kerf::scad
