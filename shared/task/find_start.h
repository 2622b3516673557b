#pragma once
// The start that a name means. A value or an exception, no side effect; any thread.

#include <string>
#include <string_view>

#include "shared/task/task.h"

namespace tenon {

/// The start of that name; null where the task has none.
[[nodiscard]] const Start* find_start(const Task& task, std::string_view name);

/// The named start, or the first where the name is empty. Offline.
/// @throws InputError where the task has none of that name
[[nodiscard]] const Start& start_or_first(const Task& task, const std::string& name);

/// "1, 2, 7": the names of all, for a message.
[[nodiscard]] std::string start_names(const Task& task);

/// "; did you mean above?" for a name that no start has, or nothing; see did_you_mean().
[[nodiscard]] std::string start_meant(const Task& task, std::string_view name);

}  // namespace tenon
