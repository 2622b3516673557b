#include "shared/base/did_you_mean.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <utility>
#include <vector>

namespace tenon {
namespace {

// Nobody writes longer words by hand, and the work grows with the square.
constexpr std::size_t kWordMax = 64;

std::size_t slips(std::string_view a, std::string_view b) {
  std::vector<std::size_t> last;
  std::vector<std::size_t> above(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t other = above[j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, other});
      const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (exchanged) row[j] = std::min(row[j], last[j - 2] + 1);
    }
    last = std::exchange(above, row);
  }
  return above[b.size()];
}

/// A number is another number, not a slip.
bool has_letters(std::string_view word) {
  return std::any_of(word.begin(), word.end(),
                     [](unsigned char letter) { return std::isalpha(letter) != 0; });
}

bool lacks_its_end(std::string_view written, std::string_view known) {
  return written.size() >= 3 && known.size() > written.size() &&
         known.substr(0, written.size()) == written && known[written.size()] == '_';
}

}  // namespace

std::string_view nearest_word(std::string_view written, std::span<const std::string_view> known) {
  if (written.empty() || written.size() > kWordMax || !has_letters(written)) return {};
  std::string_view nearest;
  std::size_t fewest = kWordMax;
  for (const std::string_view word : known) {
    if (lacks_its_end(written, word)) return word;
    const std::size_t count = slips(written, word.substr(0, kWordMax));
    if (count >= fewest || 3 * count > std::max<std::size_t>(3, word.size())) continue;
    if (count >= word.size()) continue;  // nothing of it is left
    fewest = count;
    nearest = word;
  }
  return nearest;
}

std::string did_you_mean(std::string_view written, std::span<const std::string_view> known) {
  const std::string_view nearest = nearest_word(written, known);
  return nearest.empty() ? std::string() : "; did you mean " + std::string(nearest) + "?";
}

}  // namespace tenon
