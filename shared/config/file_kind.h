#pragma once
// Which kind of file somebody has given where another was asked for. Offline.

#include <cstdint>
#include <filesystem>
#include <string>

#include "shared/config/yaml_value.h"

namespace tenon::config {

enum class FileKind : std::uint8_t {
  kTask,
  kCell,
  kRobot,
  kDrive,
  kSensor,
  kExperiment,
  kFriction,
  kResult,      ///< of a run, never asked for by these loaders
  kTruth,       ///< likewise
  kEvaluation,  ///< likewise
};

/// Refuses a document that has the keys of another kind and none of its own: "FILE: is a cell file,
/// not a task file; a cell file goes with --cell". Of any other it says nothing: the loader names
/// what is missing. @throws InputError
void expect_kind(const std::filesystem::path& file, const Value& document, FileKind wanted);

/// Refuses a plan, a log of messages, a part, a page or a URDF where YAML was asked for, and says
/// where it goes. @throws InputError
void expect_text(const std::filesystem::path& file, const std::string& text);

/// What a text is that is no plan: "is a task file, not a plan file; a task file goes first with
/// tenon-plan, elsewhere with --task"; nothing where it cannot be told.
[[nodiscard]] std::string kind_told(const std::filesystem::path& file, const std::string& text);

}  // namespace tenon::config
