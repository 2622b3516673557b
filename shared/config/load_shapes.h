#pragma once
// The shapes of a task file, meshes and their files included. Offline; throws InputError.

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "shared/config/yaml_value.h"
#include "shared/geometry/solid.h"
#include "shared/task/task.h"

namespace tenon::config {

/// Edge lengths of shapes and regions.
inline constexpr double kSizeMax_m = 100.0;

class ShapeReader {
 public:
  /// @param folder that the files of meshes are named relative to
  explicit ShapeReader(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// A list of shapes, each name once among all lists.
  [[nodiscard]] std::vector<Shape> read(const Value& value);

  /// Of the files that were read: empty where there was none, else different for different bytes.
  [[nodiscard]] const std::string& contents() const { return contents_; }

 private:
  [[nodiscard]] std::vector<Shape> read_shape(const Value& value);
  [[nodiscard]] std::shared_ptr<const Solid> read_mesh(const Value& value);

  std::filesystem::path folder_;
  std::set<std::string> names_;
  /// By file and scale: shapes may share one.
  std::map<std::pair<std::filesystem::path, double>, std::shared_ptr<const Solid>> meshes_;
  std::string contents_;
};

}  // namespace tenon::config
