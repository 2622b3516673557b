#include "sim/evaluation/figure_files.h"

#include <filesystem>
#include <utility>

#include "shared/base/text.h"
#include "shared/drawing/view.h"
#include "sim/evaluation/figures.h"

namespace tenon::sim {
namespace {

/// An element of the page as a document of its own.
std::string document(std::string svg) {
  const std::string close = "</title>";
  for (auto at = svg.find("<title>"); at != std::string::npos; at = svg.find("<title>", at)) {
    svg.erase(at, svg.find(close, at) + close.size() - at);
  }
  const std::string open = "<svg";
  svg.insert(open.size(), " xmlns='http://www.w3.org/2000/svg'");
  svg.insert(svg.find('>') + 1, std::string("\n<style>") + kFigureStyle +
                                    "</style>\n<rect width='100%' height='100%' fill='#fff'/>");
  return svg;
}

void add(std::vector<FigureFile>& files, const Evaluation& evaluation, const Candidate& candidate) {
  const std::string plan = std::filesystem::path(candidate.file).stem();
  const auto put = [&](const std::string& figure, std::string svg) {
    files.push_back({plan + "_" + figure + ".svg", document(std::move(svg))});
  };
  const std::vector<drawing::View> views = drawing::views_of(evaluation.task.coordinates);
  for (const drawing::View& view : views) {
    const std::string side =
        views.size() < 2 ? "" : std::string("_") + axis_name(view.right) + axis_name(view.up);
    put("runs" + side, figure_of_runs(evaluation, candidate, view));
    put("draws" + side, figure_of_draws(evaluation, candidate, view));
    put("ends" + side, figure_of_ends(evaluation, candidate, view));
  }
  put("errors", figure_of_errors(evaluation, candidate));
  if (!evaluation.by.empty()) put("by", figure_of_breakdown(evaluation, candidate));
}

}  // namespace

std::vector<FigureFile> figure_files(const Evaluation& evaluation) {
  std::vector<FigureFile> files;
  for (const Candidate& candidate : evaluation.candidates) add(files, evaluation, candidate);
  return files;
}

}  // namespace tenon::sim
