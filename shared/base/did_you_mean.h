#pragma once
// What somebody may have meant who wrote a word that is not known. Pure; allocates; not for real
// time.

#include <span>
#include <string>
#include <string_view>

namespace tenon {

/// The word that is fewest slips away (a letter too many, too few, another, or two exchanged:
/// optimal string alignment), where those are at most a third of its letters, or that only has more
/// to its end, as a key's unit is. Numbers are no words. Of equals the first; empty where none is
/// near.
[[nodiscard]] std::string_view nearest_word(std::string_view written,
                                            std::span<const std::string_view> known);

/// "; did you mean NEAREST?", or nothing where no word is near.
[[nodiscard]] std::string did_you_mean(std::string_view written,
                                       std::span<const std::string_view> known);

}  // namespace tenon
