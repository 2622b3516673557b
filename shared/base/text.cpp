#include "shared/base/text.h"

#include <cstdarg>
#include <cstdio>

namespace tenon {

std::string format(const char* pattern, ...) {
  std::va_list values;
  std::va_list again;
  va_start(values, pattern);
  va_copy(again, values);
  const int length = std::vsnprintf(nullptr, 0, pattern, values);
  va_end(values);
  std::string text(length > 0 ? static_cast<std::size_t>(length) : 0, '\0');
  std::vsnprintf(text.data(), text.size() + 1, pattern, again);
  va_end(again);
  return text;
}

}  // namespace tenon
