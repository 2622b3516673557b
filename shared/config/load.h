#pragma once
// Files in, files out. Everything here throws InputError with one line that names file, line, key,
// value and bound. Not for real time.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "shared/cell/cell.h"
#include "shared/experiment/world_ranges.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"

namespace tenon {

/// planner/tasks/*.yaml, or one of its variants: "FILE#VARIANT". Checks everything that can be told
/// without physics; the planner refuses a start or a goal in collision.
[[nodiscard]] Task load_task(const std::filesystem::path& name);

/// The names of a task file's variants, in its order.
[[nodiscard]] std::vector<std::string> task_variants(const std::filesystem::path& file);
/// Of a file that is given without a variant: throws what the first that does not load is refused
/// for.
void check_variants(const std::filesystem::path& name);

/// hw/robots/NAME/robot.yaml, the URDF that it names, and the profiles of drives and sensor that it
/// names.
[[nodiscard]] Robot load_robot(const std::filesystem::path& file);

/// hw/cells/NAME.yaml. The robot is named relative to the cell's file.
[[nodiscard]] Cell load_cell(const std::filesystem::path& file);

/// The files that a cell is made of, in a fixed order: its own, all in its robot's folder, and the
/// profiles of its drives and sensor.
[[nodiscard]] std::vector<std::filesystem::path> cell_files(const std::filesystem::path& file);

/// sim/experiments/*.yaml.
[[nodiscard]] WorldRanges load_experiment(const std::filesystem::path& file);

/// A .tnp file.
[[nodiscard]] Plan load_plan(const std::filesystem::path& file);

/// Throws where write_file() could not succeed; call it before work whose result would be lost.
void check_writable(const std::filesystem::path& file);

/// Writes to a temporary file beside `file`, flushes it and renames it: whole or not at all.
void write_file(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);
void write_file(const std::filesystem::path& file, const std::string& text);

}  // namespace tenon
