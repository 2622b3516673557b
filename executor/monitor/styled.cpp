#include "executor/monitor/styled.h"

#include <algorithm>
#include <cmath>

#include "shared/base/printable.h"
#include "shared/base/text.h"

namespace tenon::executor {
namespace {

// Of valid UTF-8, as printable() leaves it.
std::u32string decoded_utf8(std::string_view text) {
  std::u32string codes;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80U) {
      codes += static_cast<char32_t>(byte);
    } else if ((byte & 0xC0U) == 0x80U) {
      if (!codes.empty()) codes.back() = codes.back() << 6U | (byte & 0x3FU);
    } else {
      codes += static_cast<char32_t>(byte & (byte < 0xE0U ? 0x1FU : byte < 0xF0U ? 0x0FU : 0x07U));
    }
  }
  return codes;
}

// Latin letters are one column wide everywhere; bars' glyphs do not come as text.
char32_t one_column(char32_t code) {
  constexpr char32_t kSoftHyphen = 0xAD;
  const bool ascii = code >= 0x20 && code < 0x7F;
  const bool latin = code >= 0xA0 && code < 0x250 && code != kSoftHyphen;
  return ascii || latin ? code : U'?';
}

std::string encoded_utf8(char32_t code) {
  if (code < 0x80) return {static_cast<char>(code)};
  if (code < 0x800) {
    return {static_cast<char>(0xC0U | code >> 6U), static_cast<char>(0x80U | (code & 0x3FU))};
  }
  return {static_cast<char>(0xE0U | code >> 12U), static_cast<char>(0x80U | (code >> 6U & 0x3FU)),
          static_cast<char>(0x80U | (code & 0x3FU))};
}

}  // namespace

char32_t ascii_of(char32_t code) {
  if (code == kFill) return U'#';
  if (code == kTrack) return U'.';
  if (code == kMark) return U'|';
  return code < 0x80 ? code : U'?';
}

void put(Line& line, std::string_view text, Style style) {
  for (const char32_t code : decoded_utf8(printable(text)))
    line.push_back({one_column(code), style});
}

Line line_of(std::string_view text, Style style) {
  Line line;
  put(line, text, style);
  return line;
}

Line fitted(Line line, int width, Style blanks) {
  const auto columns = static_cast<std::size_t>(std::max(width, 0));
  const bool cut = line.size() > columns;
  line.resize(columns, {U' ', blanks});
  if (cut && !line.empty()) line.back().code = U'~';
  return line;
}

std::vector<Line> wrapped(std::string_view text, int width, std::size_t most, Style style) {
  std::vector<Line> lines;
  Line rest = line_of(text, style);
  const auto columns = static_cast<std::size_t>(std::max(width, 1));
  while (rest.size() > columns && lines.size() + 1 < most) {
    const auto end = rest.begin() + static_cast<std::ptrdiff_t>(columns) + 1;
    const auto blank = std::find_if(std::make_reverse_iterator(end), rest.rend(),
                                    [](const Glyph& glyph) { return glyph.code == U' '; });
    const bool breaks = blank != rest.rend() && blank.base() - 1 != rest.begin();
    const auto at = breaks ? blank.base() - 1 : end - 1;
    lines.emplace_back(rest.begin(), at);
    rest.erase(rest.begin(), breaks ? at + 1 : at);
  }
  lines.push_back(rest.size() > columns ? fitted(rest, width, style) : rest);
  return lines;
}

std::string text_of(const Line& line) {
  std::string text;
  for (const Glyph& glyph : line) text += encoded_utf8(glyph.code);
  return text;
}

std::string number(double value, int decimals, int columns, bool sign) {
  const auto width = static_cast<std::size_t>(std::max(columns, 1));
  std::string text = "?";
  if (std::isfinite(value)) {
    const double unit = std::pow(10.0, -decimals);
    // Without the sign of a zero.
    const double shown = std::abs(value) < 0.5 * unit ? 0.0 : value;
    text = sign ? format("%+.*f", decimals, shown) : format("%.*f", decimals, shown);
    if (text.size() > width) text = std::string(width, '>');
  }
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

void put(Line& line, const Bar& bar) {
  if (bar.width <= 0) return;
  const int last = bar.width - 1;
  const bool known =
      std::isfinite(bar.value) && bar.to > bar.from && std::isfinite(bar.to - bar.from);
  const auto column = [&](double value) {
    const double share = (value - bar.from) / (bar.to - bar.from);
    return static_cast<int>(std::lround(std::clamp(share, 0.0, 1.0) * last));
  };
  Line glyphs(static_cast<std::size_t>(bar.width), {kTrack, Style::kDim});
  const auto at = [&](int i) -> Glyph& { return glyphs[static_cast<std::size_t>(i)]; };
  if (known) {
    const int value = column(bar.value);
    const int origin = bar.point ? value : column(bar.origin);
    const bool nothing = value == origin && !bar.point;
    for (int i = std::min(value, origin); i <= std::max(value, origin) && !nothing; ++i) {
      at(i) = {kFill, bar.style};
    }
    for (const double mark : bar.marks) {
      if (!std::isfinite(mark) || mark < bar.from || mark > bar.to) continue;
      Glyph& glyph = at(column(mark));
      glyph = {kMark, glyph.code == kFill ? bar.style : Style::kNormal};
    }
    if (bar.value > bar.to) at(last) = {U'>', bar.style};
    if (bar.value < bar.from) at(0) = {U'<', bar.style};
  }
  line.insert(line.end(), glyphs.begin(), glyphs.end());
}

}  // namespace tenon::executor
