#pragma once
// How a guarded move can end.

#include <array>
#include <cstdint>

namespace tenon {

/// The numbers stand in plan files.
enum class Outcome : std::uint8_t {
  kReached = 0,  ///< the command is finished
  kContact = 1,  ///< the contact signature gained a bit that the trigger mask watches
  kRelease = 2,  ///< it lost one
  kBlocked = 3,  ///< the force limit holds the tool in place, signature unchanged
  kTimeout = 4,  ///< the time limit passed
};
inline constexpr std::array<Outcome, 5> kOutcomes = {
    Outcome::kReached, Outcome::kContact, Outcome::kRelease, Outcome::kBlocked, Outcome::kTimeout};

[[nodiscard]] constexpr const char* to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::kReached:
      return "reached";
    case Outcome::kContact:
      return "contact";
    case Outcome::kRelease:
      return "release";
    case Outcome::kBlocked:
      return "blocked";
    case Outcome::kTimeout:
      return "timeout";
  }
  return "?";
}

}  // namespace tenon
