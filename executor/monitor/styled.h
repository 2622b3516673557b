#pragma once
// Lines of styled glyphs, each one column wide: what a terminal is to show, before there is any.
// Pure; allocates, not for real time.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tenon::executor {

enum class Style : std::uint8_t {
  kNormal = 0,
  kDim = 1,    ///< what is old, or not known
  kTitle = 2,  ///< of a block
  kGood = 3,
  kWarn = 4,     ///< near a bound
  kBad = 5,      ///< at a bound, or beyond
  kContact = 6,  ///< held
  kGoodBanner = 7,
  kWarnBanner = 8,
  kBadBanner = 9,
  kKeys = 10,
};
inline constexpr Style kLastStyle = Style::kKeys;

struct Glyph {
  char32_t code = U' ';
  Style style = Style::kNormal;

  friend bool operator==(const Glyph&, const Glyph&) = default;
};
using Line = std::vector<Glyph>;

// What bars are made of.
inline constexpr char32_t kFill = U'\u2588';   // full block
inline constexpr char32_t kTrack = U'\u00B7';  // middle dot
inline constexpr char32_t kMark = U'\u2502';   // vertical line

/// For terminals that have no more than ASCII.
[[nodiscard]] char32_t ascii_of(char32_t code);

/// Appends text. Control characters and what is not UTF-8 stand as \xHH; what might not be one
/// column wide as '?'.
void put(Line& line, std::string_view text, Style style = Style::kNormal);
[[nodiscard]] Line line_of(std::string_view text, Style style = Style::kNormal);
/// As wide as asked for: filled with blanks, or cut, and then '~' stands last.
[[nodiscard]] Line fitted(Line line, int width, Style blanks = Style::kNormal);
/// Text in lines of at most `width` columns, broken between words where that goes. What would be
/// more than `most` lines is cut.
[[nodiscard]] std::vector<Line> wrapped(std::string_view text, int width, std::size_t most,
                                        Style style = Style::kNormal);
/// Without styles, for tests and people.
[[nodiscard]] std::string text_of(const Line& line);

/// A number right-aligned in so many columns; "?" where it is none, ">" where it does not fit.
[[nodiscard]] std::string number(double value, int decimals, int columns, bool sign = false);

/// A bar over `width` columns from `from` to `to`; marks stand over the filling. Values beyond the
/// ends fill to the end, where an arrow stands.
struct Bar {
  int width = 0;
  double from = 0.0;
  double to = 1.0;
  double value = 0.0;
  double origin = 0.0;  ///< where the filling starts
  bool point = false;   ///< the value alone is filled
  std::vector<double> marks{};
  Style style = Style::kGood;
};
void put(Line& line, const Bar& bar);

}  // namespace tenon::executor
