#include "shared/task/find_start.h"

#include <algorithm>
#include <vector>

#include "shared/base/did_you_mean.h"
#include "shared/base/error.h"

namespace tenon {

const Start* find_start(const Task& task, std::string_view name) {
  const auto found = std::find_if(task.starts.begin(), task.starts.end(),
                                  [&](const Start& start) { return start.name == name; });
  return found == task.starts.end() ? nullptr : &*found;
}

const Start& start_or_first(const Task& task, const std::string& name) {
  if (name.empty() && !task.starts.empty()) return task.starts.front();
  if (const Start* start = find_start(task, name)) return *start;
  throw InputError("task " + task.name + ": start \"" + name +
                   "\" does not exist, must be one of " + start_names(task) +
                   start_meant(task, name));
}

std::string start_names(const Task& task) {
  std::string names;
  for (const Start& start : task.starts) names += (names.empty() ? "" : ", ") + start.name;
  return names;
}

std::string start_meant(const Task& task, std::string_view name) {
  std::vector<std::string_view> names;
  names.reserve(task.starts.size());
  for (const Start& start : task.starts) names.emplace_back(start.name);
  return did_you_mean(name, names);
}

}  // namespace tenon
