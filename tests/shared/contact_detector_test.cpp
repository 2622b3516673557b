// When a bit appears and when it goes.

#include "shared/motion/contact_detector.h"

#include <gtest/gtest.h>

#include <initializer_list>

#include "shared/motion/guarded_move.h"

namespace tenon {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::uint8_t kAllAxes = 0x3F;
const ContactSignature kPlusX{ContactSignature::bit(0, +1)};
const ContactSignature kMinusX{ContactSignature::bit(0, -1)};
const ContactSignature kNone{};

Vector6 push(int axis, double value) {
  Vector6 wrench = Vector6::Zero();
  wrench[axis] = value;
  return wrench;
}

// Feeds forces along x (N), one every 2 ms, and remembers the signature after each.
class Line {
 public:
  explicit Line(ContactSignature initial = {}) : detector_({}, kAllAxes, initial) {}

  ContactSignature after(std::initializer_list<double> forces_N) {
    for (const double force_N : forces_N) {
      detector_.update(time_ns_, push(0, force_N));
      time_ns_ += 2 * kMillisecond_ns;
    }
    return detector_.signature();
  }
  ContactDetector& detector() { return detector_; }

 private:
  ContactDetector detector_;
  std::int64_t time_ns_ = 0;
};

// on 6 N, keep 3 N, off 1.5 N, debounce 6 ms, a sample every 2 ms:
//
//   ms      0   2   4   6   8
//   N       0   7   7   7   7
//   above   .   |<--- 6 ms -->|
//   bit     .   .   .   .   set
TEST(ContactDetector, BitAppearsOnceTheDebounceHasPassed) {
  Line line;
  EXPECT_EQ(line.after({0.0, 7.0, 7.0, 7.0}), kNone);
  EXPECT_EQ(line.detector().candidates(), kPlusX);
  EXPECT_EQ(line.after({7.0}), kPlusX);
  EXPECT_EQ(line.detector().candidates(), kNone);
}

//   ms      0   2   4   6   8  10  12  14
//   N       7   7   7   5   7   7   7   7
//   above   |<------>   .   |<--- 6 ms -->|
//   bit     .   .   .   .   .   .   .   set
TEST(ContactDetector, OneSampleBelowStartsTheDebounceAgain) {
  Line line;
  EXPECT_EQ(line.after({7.0, 7.0, 7.0, 5.0}), kNone);
  EXPECT_EQ(line.detector().candidates(), kNone);
  EXPECT_EQ(line.after({7.0, 7.0, 7.0}), kNone);
  EXPECT_EQ(line.after({7.0}), kPlusX);
}

//   ms         0   2   4   6   8  10
//   N          5.8 7  5.8  5  5.8  7
//   candidate  .  yes yes  .   .  yes
TEST(ContactDetector, NoiseAboutTheThresholdDoesNotEndACandidacy) {
  Line line;
  line.after({5.8});
  EXPECT_EQ(line.detector().candidates(), kNone);
  line.after({7.0, 5.8});
  EXPECT_EQ(line.detector().candidates(), kPlusX);
  line.after({5.0});
  EXPECT_EQ(line.detector().candidates(), kNone);
  line.after({5.8});
  EXPECT_EQ(line.detector().candidates(), kNone);
  line.after({7.0});
  EXPECT_EQ(line.detector().candidates(), kPlusX);
}

//   ms      0   2   4   6   8  10  12  14  16  18  20  22
//   N       7   7   7   7   3 1.6 1.4 1.4 1.6 1.4 1.4 1.4 1.4
//   below   .   .   .   .   .   . |<--->  .  |<--- 6 ms -->|
//   bit     .   .   .  set ........................... gone
TEST(ContactDetector, BitStaysBetweenTheThresholdsAndGoesBelowTheLowerOne) {
  Line line;
  EXPECT_EQ(line.after({7.0, 7.0, 7.0, 7.0}), kPlusX);
  EXPECT_EQ(line.after({3.0, 1.6, 1.6, 1.6, 1.6, 1.6}), kPlusX);
  EXPECT_EQ(line.after({1.4, 1.4, 1.6}), kPlusX);
  EXPECT_EQ(line.after({1.4, 1.4, 1.4}), kPlusX);
  EXPECT_EQ(line.after({1.4}), kNone);
}

TEST(ContactDetector, ForceAtTheThresholdIsNotAbove) {
  Line line;
  EXPECT_EQ(line.after({6.0, 6.0, 6.0, 6.0, 6.0, 6.0}), kNone);
}

TEST(ContactDetector, PushTowardsMinusSetsTheMinusBit) {
  Line line;
  EXPECT_EQ(line.after({-7.0, -7.0, -7.0, -7.0}), kMinusX);
}

TEST(ContactDetector, SignChangeMovesTheBitOver) {
  Line line(kPlusX);
  EXPECT_EQ(line.after({-7.0, -7.0, -7.0, -7.0}), kMinusX);
}

TEST(ContactDetector, TorquesHaveThresholdsOfTheirOwn) {
  ContactDetector detector({}, kAllAxes, {});
  for (int i = 0; i < 5; ++i) detector.update(2 * i * kMillisecond_ns, push(4, -0.7));
  EXPECT_EQ(to_string(detector.signature()), "-ry");
}

TEST(ContactDetector, AxisThatIsNotWatchedFeelsNothing) {
  ContactDetector detector({}, 0b000010, {});
  for (int i = 0; i < 5; ++i) detector.update(2 * i * kMillisecond_ns, push(0, 50.0));
  EXPECT_EQ(detector.signature(), kNone);
  EXPECT_EQ(detector.candidates(), kNone);
}

TEST(ContactDetector, OneSampleAloneNeverChangesABit) {
  ContactThresholds thresholds;
  thresholds.debounce_us = 0;
  ContactDetector detector(thresholds, kAllAxes, {});
  detector.update(0, push(0, 100.0));
  EXPECT_EQ(detector.signature(), kNone);
  detector.update(1, push(0, 100.0));
  EXPECT_EQ(detector.signature(), kPlusX);
}

// The sensor repeats its last sample for 100 ms: that is one sample, not fifty.
//
//   ms      0   2   4   6  ...  100 102 104
//   N       0   9  (9) (9) ... (9)  9   9     () stale
//   bit     .   .   .   .  ...  .  set
TEST(ContactDetector, StaleSamplesDoNotCountTowardsTheDebounce) {
  GuardedMove move({}, {});
  const auto update = [&move](std::int64_t time_ms, double force_N, bool fresh) {
    GuardedMove::Input input;
    input.time_ns = time_ms * kMillisecond_ns;
    input.wrench = push(0, force_N);
    input.wrench_fresh = fresh;
    (void)move.update(input);
  };
  update(0, 0.0, true);
  update(2, 9.0, true);
  for (std::int64_t time_ms = 4; time_ms <= 100; time_ms += 2) {
    update(time_ms, 9.0, false);
    EXPECT_EQ(move.signature(), kNone) << time_ms << " ms";
  }
  update(102, 9.0, true);
  EXPECT_EQ(move.signature(), kPlusX);
}

}  // namespace
}  // namespace tenon
