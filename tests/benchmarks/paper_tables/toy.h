#pragma once
// Table I: in which order the one-dimensional example is searched.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "shared/ports/rollout.h"
#include "shared/task/task.h"

namespace tenon::paper_tables {

struct Expansion {
  std::string turn;      ///< whose turn it was: the guide to the left or to the right wall
  bool led = false;      ///< whether that guide chose (line 37), or else the anchor
  std::string selector;  ///< h0, or the guide; h_g once nothing is uncertain any more
  std::string parent;
  std::vector<std::string> children;  ///< those that nobody had seen before
};

/// Searches once, without certification.
[[nodiscard]] std::vector<Expansion> expansions_of(const Task& toy, const Rollout& rollout);

[[nodiscard]] std::string text_of(const std::vector<Expansion>& ours);
[[nodiscard]] nlohmann::ordered_json json_of(const std::vector<Expansion>& ours);

}  // namespace tenon::paper_tables
