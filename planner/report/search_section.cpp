#include "planner/report/search_section.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "shared/base/text.h"
#include "shared/drawing/html.h"

namespace tenon::planner {
namespace {

std::size_t expansions_of(const SearchRound& round) {
  return std::accumulate(round.expansions.begin(), round.expansions.end(), std::size_t{0});
}

/// By heuristic, of all searches.
std::vector<std::size_t> expansions_by_queue(const SearchStory& story) {
  std::vector<std::size_t> sums(story.heuristics.size());
  for (const SearchRound& round : story.rounds) {
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += round.expansions[i];
  }
  return sums;
}

std::size_t expansions_of(const SearchStory& story) {
  const std::vector<std::size_t> sums = expansions_by_queue(story);
  return std::accumulate(sums.begin(), sums.end(), std::size_t{0});
}

bool is_searched(const SearchStory& story) { return !story.expansions.empty(); }

/// What was found, in a sentence or two.
std::string found(const SearchStory& story) {
  const std::string effort =
      format("%zu search%s made %zu expansion%s; %zu state%s seen. ", story.rounds.size(),
             story.rounds.size() == 1 ? "" : "es", expansions_of(story),
             plural(expansions_of(story)), story.states, story.states == 1 ? " was" : "s were");
  if (!story.guide.empty()) {
    return "The plan follows the guide " + story.guide + " to the letter. " +
           (story.rounds.empty() ? "Nothing was searched. " : effort) + "No bound is proven.";
  }
  if (!is_searched(story)) return effort + "No bound is proven.";
  const double cost = story.costs.back();
  const double least = story.lower_bounds.back();
  return effort + format("The path that became the plan costs %.0f, ", cost) +
         (story.bound > 0.0
              ? format("and any path of the searched graph at least %.0f: it is at most %.2f times "
                       "the optimum.",
                       least, story.bound)
              : "and no bound is proven.") +
         " The search adds up moves that it simulated one by one, where nothing turns in coarser "
         "time steps; the plan's own cost is that of the certified chain, run from start to end at "
         "the plan's speeds, and may differ a little.";
}

std::string table_of(const std::string& titles, const std::string& rows) {
  return "<div class='wide'><table><thead><tr>" + titles + "</tr></thead>\n<tbody>\n" + rows +
         "</tbody></table></div>\n";
}

std::string title(const char* text) { return std::string("<th scope='col'>") + text + "</th>"; }

std::string queue_table(const SearchStory& story) {
  const std::vector<std::size_t> sums = expansions_by_queue(story);
  const auto all = static_cast<double>(std::max<std::size_t>(1, expansions_of(story)));
  std::string rows;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double share = static_cast<double>(sums[i]) / all;
    rows += "<tr><th scope='row'>" + drawing::escaped(story.heuristics[i]) +
            format(
                "</th><td class='num'>%zu</td><td class='num'>%.0f %%</td><td class='share' "
                "aria-hidden='true'><i style='width:%.1f%%'></i></td></tr>\n",
                sums[i], 1e2 * share, 1e2 * share);
  }
  return table_of(title("Led by") + title("Expansions") + title("Share") +
                      "<td class='share' aria-hidden='true'></td>",
                  rows);
}

/// Steps from one value to the next, as they held. Infinite ones are left out.
std::string stairs(const SearchStory& story, const std::vector<double>& values, double most,
                   const char* name) {
  constexpr double kWidth = 1000.0;
  constexpr double kHeight = 100.0;
  const auto last = static_cast<double>(std::max<std::size_t>(1, story.expansions.back()));
  std::vector<drawing::Point> points;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    const double x = kWidth * static_cast<double>(story.expansions[i]) / last;
    if (!points.empty()) points.emplace_back(x, points.back().y());
    points.emplace_back(x, kHeight * (1.0 - values[i] / most));
  }
  if (points.size() == 1) points.push_back(points.front());  // a dot, by the line's round end
  return format("<polyline class='%s' points='", name) + drawing::points_text(points, 1) + "'/>";
}

std::string course(const SearchStory& story) {
  if (!is_searched(story)) return {};
  double most = std::max(1e-9, story.lower_bounds.back());
  std::size_t first = story.expansions.back();
  for (std::size_t i = story.costs.size(); i-- > 0;) {
    if (!std::isfinite(story.costs[i])) break;
    most = std::max(most, story.costs[i]);
    first = story.expansions[i];
  }
  const std::string words = format(
      "Cost against bound: a path from expansion %zu of %zu on, in the end of cost %.0f; by then "
      "any "
      "path costs at least %.0f.",
      first, story.expansions.back(), story.costs.back(), story.lower_bounds.back());
  return "<figure class='course'>" + format("<p class='scale'>cost %.0f</p>", most) +
         "<svg role='img' aria-label='" + words +
         "' viewBox='0 -4 1000 108' preserveAspectRatio='none'>" +
         stairs(story, story.lower_bounds, most, "least") +
         stairs(story, story.costs, most, "cost") +
         format("<path d='M0 %.1fH1000'/>", 100.0 * (1.0 - story.costs.back() / most)) + "</svg>" +
         format("<p class='scale'><span>0</span><span>%zu expansions</span></p>",
                story.expansions.back()) +
         "<figcaption><span class='key'><i class='cost'></i>cost of the best path; thin: of "
         "the last</span> "
         "<span class='key'><i class='least'></i>proven: no path costs less</span> " +
         words + "</figcaption></figure>\n";
}

std::string round_table(const SearchStory& story) {
  if (story.rounds.empty()) return {};
  std::string rows;
  for (std::size_t i = 0; i < story.rounds.size(); ++i) {
    const SearchRound& round = story.rounds[i];
    rows +=
        format("<tr><th scope='row'>%zu</th><td class='num'>%g, %g</td><td class='num'>%zu</td>",
               i + 1, round.parameters.w1, round.parameters.w2, expansions_of(round));
    rows += round.steps == 0 ? "<td class='num'>none</td><td></td>"
                             : format("<td class='num'>%zu step%s</td><td class='num'>%.0f</td>",
                                      round.steps, plural(round.steps), round.cost);
    rows += format("<td class='num'>%.0f</td><td>", round.lower_bound) +
            drawing::escaped(round.outcome) + "</td></tr>\n";
  }
  return "<details><summary>Every search and what came of its path</summary>\n" +
         table_of(title("Search") + title("Weights") + title("Expansions") + title("Path") +
                      title("Cost") + title("At least") + title("What came of it"),
                  rows) +
         "</details>\n";
}

const char* doing(const std::string& phase) {
  if (phase == "attractors") return "Looking for guides";
  if (phase == "search") return "Searching";
  if (phase == "certification") return "Certifying";
  if (phase == "corners") return "Running the corners";
  return "Validating";
}

std::string phase_table(const SearchStory& story) {
  std::string rows;
  for (const SearchStory::Phase& phase : story.phases) {
    rows += format(
        "<tr><th scope='row'>%s</th><td class='num'>%.2f s</td><td class='num'>%llu</td>"
        "</tr>\n",
        doing(phase.name), phase.time_s, static_cast<unsigned long long>(phase.moves));
  }
  return table_of(title("Phase") + title("Time") + title("Simulated moves"), rows);
}

}  // namespace

std::string search_section(const SearchStory& story) {
  return "<section aria-labelledby='search'><h2 id='search'>The search</h2>\n<p>" +
         drawing::escaped(found(story)) + "</p>\n" + course(story) +
         (story.rounds.empty() ? std::string() : queue_table(story)) + round_table(story) +
         phase_table(story) + "</section>\n";
}

std::string search_text(const SearchStory& story) {
  std::string text = "search: " + found(story) + "\n";
  const std::vector<std::size_t> sums = expansions_by_queue(story);
  for (std::size_t i = 0; i < sums.size() && !story.rounds.empty(); ++i) {
    text += format("  %6zu expansion%s by ", sums[i], plural(sums[i])) + story.heuristics[i] + "\n";
  }
  for (const SearchStory::Phase& phase : story.phases) {
    text += format("  %8.2f s, %llu move%s: ", phase.time_s,
                   static_cast<unsigned long long>(phase.moves), plural(phase.moves)) +
            phase.name + "\n";
  }
  return text;
}

}  // namespace tenon::planner
