// Evaluation of a probe's input while a path runs.
#include "firmware/core/path/probe_watch.hpp"

#include <gtest/gtest.h>

#include "hal/pc/simulated_panel.hpp"

namespace {

using firmware::ProbeContact;
using firmware::ProbeStop;
using firmware::ProbeWatch;

constexpr int kSamples = 3;

struct WatchedProbe {
  WatchedProbe(ProbeContact contact, ProbeStop stop, bool closed) {
    input.turn(closed);
    watch.configure(contact, stop, kSamples);
    began = watch.begin(input);
  }
  /// Runs this many control periods; returns the period in which the state was reached, 0 if it was not reached.
  int run(int periods) {
    for (int k = 1; k <= periods; ++k)
      if (watch.has_come(input)) return k;
    return 0;
  }
  hal::pc::SimulatedProbe input;
  ProbeWatch watch;
  bool began = false;
};

TEST(ProbeWatch, FindsWhatItLooksForHoweverTheContactIsWired) {
  for (const auto contact : {ProbeContact::closes, ProbeContact::opens})
    for (const auto stop : {ProbeStop::contact, ProbeStop::release}) {
      const bool closed_when_found = (contact == ProbeContact::closes) == (stop == ProbeStop::contact);
      WatchedProbe probing(contact, stop, !closed_when_found);
      EXPECT_TRUE(probing.began);
      EXPECT_EQ(probing.run(100), 0);
      probing.input.turn(closed_when_found);
      EXPECT_TRUE(probing.input.has_latched());
      EXPECT_EQ(probing.run(100), kSamples);
      EXPECT_TRUE(probing.input.has_latched());
      EXPECT_FALSE(WatchedProbe(contact, stop, closed_when_found).began) << "it is there already";
    }
}

TEST(ProbeWatch, ForgetsASparkAndKeepsTheFirstEdgeOfABounce) {
  WatchedProbe probing(ProbeContact::closes, ProbeStop::contact, false);
  probing.input.turn(true);
  EXPECT_EQ(probing.run(1), 0);
  probing.input.turn(false);
  EXPECT_EQ(probing.run(kSamples - 1), 0);
  EXPECT_TRUE(probing.input.has_latched()) << "it may close again";
  probing.input.turn(true);
  EXPECT_EQ(probing.run(1), 0);
  probing.input.turn(false);
  EXPECT_EQ(probing.run(kSamples), 0);
  EXPECT_FALSE(probing.input.has_latched());
  probing.input.turn(true);
  EXPECT_EQ(probing.run(100), kSamples);
}

TEST(ProbeWatch, OnAnyOtherPathOnlyANewContactCounts) {
  WatchedProbe moving(ProbeContact::opens, ProbeStop::none, false);
  EXPECT_TRUE(moving.began) << "away from a surface";
  EXPECT_EQ(moving.run(100), 0);
  moving.input.turn(true);
  EXPECT_EQ(moving.run(100), 0);
  moving.input.turn(false);
  EXPECT_EQ(moving.run(100), kSamples);
}

}  // namespace
