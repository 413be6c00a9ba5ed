// Numbered items of work on several threads.
#include "base/parallel.h"

#include <gtest/gtest.h>
#include <new>
#include <set>
#include <vector>

namespace kerf {
namespace {

const auto kNeverStop = [] { return false; };

TEST(Parallel, EveryItemIsDoneOnce) {
  for (const unsigned threads : {1u, 2u, 7u}) {
    for (const std::size_t count : {0u, 1u, 2u, 1000u}) {
      std::vector<int> done(count, 0);
      parallel_for(
          threads, count, [&](std::size_t i) { ++done[i]; }, kNeverStop);
      EXPECT_EQ(done, std::vector<int>(count, 1)) << threads << " threads";
    }
  }
}

TEST(Parallel, ATeamDoesManyRounds) {
  for (const unsigned threads : {1u, 2u, 5u}) {
    Team team(threads);
    std::vector<int> done(64, 0);
    for (int round = 0; round < 2000; ++round)
      team.run(
          static_cast<std::size_t>(round % 65), [&](std::size_t i) { ++done[i]; }, kNeverStop);
    for (std::size_t i = 0; i < done.size(); ++i) {
      int wanted = 0;
      for (int round = 0; round < 2000; ++round) wanted += i < static_cast<std::size_t>(round % 65) ? 1 : 0;
      EXPECT_EQ(done[i], wanted) << threads << " threads, item " << i;
    }
  }
}

TEST(Parallel, HelpersTakePart) {
  Team team(3);
  std::set<std::thread::id> seen;
  std::atomic<int> arrived{0};
  std::vector<std::thread::id> who(3);
  // Each item waits for the two others, so that no thread can do two.
  team.run(
      3,
      [&](std::size_t i) {
        who[i] = std::this_thread::get_id();
        ++arrived;
        while (arrived < 3) std::this_thread::yield();
      },
      kNeverStop);
  seen.insert(who.begin(), who.end());
  EXPECT_EQ(seen.size(), 3u);
}

TEST(Parallel, AStoppedRoundEndsAndTheNextIsWhole) {
  Team team(2);
  std::atomic<std::size_t> done{0};
  bool asked = false;
  team.run(
      1000000, [&](std::size_t) { ++done; }, [&] { return asked = true; });
  EXPECT_TRUE(asked);
  EXPECT_LT(done, 1000000u);
  done = 0;
  team.run(
      100, [&](std::size_t) { ++done; }, kNeverStop);
  EXPECT_EQ(done, 100u);
}

TEST(Parallel, ExceptionsOfItemsAreRethrown) {
  for (const unsigned threads : {1u, 2u, 5u}) {
    Team team(threads);
    for (const std::size_t bad : {0u, 37u, 999u}) {
      const auto work = [&](std::size_t i) {
        if (i == bad) throw std::bad_alloc();
      };
      EXPECT_THROW(team.run(1000, work, kNeverStop), std::bad_alloc) << threads << " threads, item " << bad;
    }
    std::atomic<std::size_t> done{0};
    team.run(
        100, [&](std::size_t) { ++done; }, kNeverStop);
    EXPECT_EQ(done, 100u) << "after an error";
  }
}

}  // namespace
}  // namespace kerf
