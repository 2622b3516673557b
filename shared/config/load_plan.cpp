#include "shared/base/error.h"
#include "shared/config/file_kind.h"
#include "shared/config/files.h"
#include "shared/config/load.h"
#include "shared/plan/codec.h"

namespace tenon {

Plan load_plan(const std::filesystem::path& file) {
  const std::string text = config::read_file(file);
  DecodedPlan decoded =
      decode_plan({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  if (!decoded.plan) {
    if (!text.starts_with("TNP")) {
      const std::string told = config::kind_told(file, text);
      throw InputError(file.string() + ": " +
                       (told.empty() ? "is not a plan file, which tenon-plan -o writes" : told));
    }
    throw InputError(file.string() + ": byte " + std::to_string(decoded.offset) + ", " +
                     decoded.field + ": " + to_string(decoded.error) + "; plan again");
  }
  return *std::move(decoded.plan);
}

}  // namespace tenon
