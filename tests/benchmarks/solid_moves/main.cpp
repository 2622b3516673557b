// The study of tests/solids over pairs of a folder of yours, FOLDER/PAIR/plug.* and socket.*, both
// in the assembled pose: drawn moves of the plug about the socket, one line a pair. Exit status 1
// where a pair is not sound.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "planner/new_task/part_fit.h"
#include "shared/base/error.h"
#include "shared/config/part_file.h"
#include "shared/system/fan_out.h"
#include "tests/solids/solid_moves.h"

namespace tenon::tests {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUsage =
    "usage: solid_moves FOLDER [MOVES] [SEED]\n"
    "  FOLDER/PAIR/plug.obj or .stl and socket.obj or .stl, assembled; 100 moves a pair\n";

fs::path part_of(const fs::path& pair, const std::string& name) {
  for (const char* kind : {".obj", ".stl", ".OBJ", ".STL"}) {
    if (fs::exists(pair / (name + kind))) return pair / (name + kind);
  }
  throw InputError(pair.string() + ": no " + name + ".obj and no " + name + ".stl");
}

bool run(const fs::path& folder, const SolidMovesOptions& options) {
  SolidPair pair;
  pair.held = config::load_part(part_of(folder, "plug")).solid;
  pair.environment = config::load_part(part_of(folder, "socket")).solid;
  const planner::PartFit fit = planner::fit_of(pair.held, pair.environment, {});
  const std::string name = folder.filename().string();
  if (!fit.way_out) {
    std::printf("%-12s no straight way out: passed over\n", name.c_str());
    return true;
  }
  pair.way_out = *fit.way_out;
  pair.depth_m = fit.depth_m;
  pair.play_m = std::min(fit.play_m[0], fit.play_m[1]);
  const SolidMovesSeen seen = run_solid_moves(pair, options);
  const double allowed_m = std::max(0.1 * pair.play_m, 50e-6);
  const bool sound = seen.invalid == 0 && seen.depth_max_m <= allowed_m;
  std::printf(
      "%-12s %6zu moves %6zu contacts %7zu/%zu instants in contact  deepest %6.1f um of %6.1f  "
      "%s%s\n",
      name.c_str(), seen.moves, seen.contacts, seen.meeting, seen.instants, 1e6 * seen.depth_max_m,
      1e6 * allowed_m, sound ? "sound" : "NOT SOUND ", seen.first_invalid.c_str());
  std::fflush(stdout);
  return sound;
}

}  // namespace
}  // namespace tenon::tests

int main(int argc, char** argv) try {
  if (argc < 2 || argc > 4) {
    std::fputs(tenon::tests::kUsage, stderr);
    return 2;
  }
  tenon::tests::SolidMovesOptions options;
  if (argc > 2) options.moves = std::stoul(argv[2]);
  if (argc > 3) options.seed = std::stoull(argv[3]);
  options.threads = tenon::all_cores();
  std::vector<std::filesystem::path> pairs;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) {
    if (entry.is_directory()) pairs.push_back(entry.path());
  }
  std::sort(pairs.begin(), pairs.end());
  bool sound = true;
  for (const auto& pair : pairs) sound = tenon::tests::run(pair, options) && sound;
  return sound ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "solid_moves: %s\n", error.what());
  return 2;
}
