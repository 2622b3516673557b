#pragma once
// The contact-greedy baseline of Kim and Likhachev, "Parts Assembly Planning under Uncertainty with
// Simulation-Aided Physical Reasoning" (ICRA 2017), section V-B: a planner that knows one particle
// only, but gets to the nearest contact as soon as possible, since contact makes any start more
// certain. The paper says no more than that; here it means two searches, one after the other:
//   1. the shortest way, by the cost of the edges, to any state with a contact;
//   2. from that state the way to the goal, with the anchor as the only heuristic.
// Touching is the first thing that such a plan does, whether or not the goal lies that way, and
// nothing weighs one contact against another.

#include <functional>

#include "planner/search/belief_graph.h"
#include "planner/search/mha_search.h"

namespace tenon::planner {

/// One path out of both searches, with their expansions. No bound is claimed for it: the nearest
/// contact need not lie on any good way. The budget is that of both together.
[[nodiscard]] SearchResult contact_greedy_search(BeliefGraph& graph,
                                                 const SearchParameters& parameters,
                                                 const std::function<bool()>& stop);

}  // namespace tenon::planner
