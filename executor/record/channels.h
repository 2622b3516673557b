#pragma once
// The channels that telemetry goes out on, over the network and into a log.

namespace tenon::executor {

inline constexpr const char* kCycleChannel = "TENON_CYCLE";
inline constexpr const char* kStepChannel = "TENON_STEP";
inline constexpr const char* kRunChannel = "TENON_RUN";
inline constexpr const char* kSetupChannel = "TENON_SETUP";
inline constexpr const char* kStatusChannel = "TENON_STATUS";

}  // namespace tenon::executor
