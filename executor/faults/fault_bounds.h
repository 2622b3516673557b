#pragma once
// The patience of the executor's detectors, said once: the detectors and the table of faults take
// it from here.

namespace tenon::executor {

inline constexpr int kFeedbackMissesMax = 10;    ///< cycles in a row without a joint's answer
inline constexpr double kWrenchAgeMax_s = 0.05;  ///< without a new wrench
inline constexpr int kWrenchSamplesMin = 8;      ///< the age allowed is at least so many samples
inline constexpr int kBlindSamplesMin = 10;      ///< likewise
inline constexpr double kBlindMax_s = 0.1;       ///< without a sample that guarded moves may see
inline constexpr double kFollowingPatience_s = 0.02;  ///< 6066h of the drives: half
inline constexpr double kEnableTimeout_s = 5.0;       ///< for the drives
inline constexpr double kBrakeWatch_s = 0.5;          ///< after the drives are off
inline constexpr double kBrakeCreep_s = 5.0;          ///< while a joint moves on within its play
inline constexpr double kHeldPatience_s = 0.1;        ///< at the plan's end
inline constexpr double kDisableTimeout_s = 3.0;      ///< for the drives to say that they are off
inline constexpr double kZeroWatch_s = 2.0;           ///< at the plan's end
inline constexpr int kTareSamples = 200;
inline constexpr int kTareTries = 5;              ///< while the sensor is not steady
inline constexpr int kFrozenSamples = 7;          ///< equal ones in a row
inline constexpr int kFrozenAxisSamples = 72;     ///< of one axis alone, at the most
inline constexpr int kFrozenEffortCycles = 72;    ///< of a joint's motion, at the most
inline constexpr int kTouchSamples = 2;           ///< above the threshold that make a contact
inline constexpr int kLateCyclesMost = 50;        ///< at once
inline constexpr int kIncompleteCyclesMost = 30;  ///< at once

}  // namespace tenon::executor
