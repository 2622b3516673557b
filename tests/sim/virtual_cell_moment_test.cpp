// What people see of the virtual cell while it runs, and that looking changes nothing.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/sim/literal_cell.h"

namespace tenon::sim {
namespace {

VirtualCell::Options watched_options() {
  VirtualCell::Options options;
  options.watched = true;
  return options;
}

/// Shapes of wall_task()'s environment.
constexpr std::uint16_t kTable = 0;
constexpr std::uint16_t kWall = 1;

bool touched(const CellMoment& moment, std::uint16_t shape) {
  const auto end = moment.touched.begin() + moment.touched_count;
  return std::find(moment.touched.begin(), end, shape) != end;
}

TEST(CellMomentTest, TellsDrivesBrakesAndWhereThePartIs) {
  LiteralCell bench(gantry_cell(), wall_task(), watched_options());
  const CellMoment before = bench.cell.moment();
  EXPECT_EQ(before.enabled, 0);
  EXPECT_EQ(before.braked, 3);
  ASSERT_TRUE(bench.enable());
  bench.move(0, -200, 100);
  bench.cycles_of(0x0F, 50);
  const CellMoment after = bench.cell.moment();
  EXPECT_EQ(after.enabled, 3);
  EXPECT_EQ(after.braked, 0);
  EXPECT_EQ(after.faulted, 0);
  EXPECT_GT(after.time_s, before.time_s + 0.3);
  EXPECT_NEAR(after.position_m[0], before.position_m[0] - 0.02, 1e-5);
  EXPECT_NEAR(after.position_m[1], before.position_m[1], 1e-5);
  EXPECT_EQ(after.touched_count, 0);
  EXPECT_EQ(after.force_N_max, 0.0);
}

//  the cube's +x face    0.05 ────> |wall at 0.10
//  pressed on it, then left: the moment in which it left still tells of it, the next one does not.
TEST(CellMomentTest, TellsATouchThatIsOverInTheMomentInWhichItWas) {
  LiteralCell bench(gantry_cell(), wall_task(), watched_options());
  ASSERT_TRUE(bench.enable());
  bench.move(0, 200, 255);  // 51 mm: 1 mm beyond the wall's face
  bench.cycles_of(0x0F, 50);
  (void)bench.cell.moment();
  bench.cycles_of(0x0F, 10);
  const CellMoment pressing = bench.cell.moment();
  EXPECT_TRUE(touched(pressing, kWall));
  EXPECT_FALSE(touched(pressing, kTable));
  ASSERT_GT(pressing.point_count, 0);
  EXPECT_NEAR(pressing.points_m[0][0] - pressing.position_m[0], 0.05, 2e-3);
  EXPECT_LT(pressing.force_N[0], -10.0);
  EXPECT_GE(pressing.force_N_max, -pressing.force_N[0]);
  bench.move(0, -200, 50);
  bench.cycles_of(0x0F, 50);
  const CellMoment leaving = bench.cell.moment();
  EXPECT_TRUE(touched(leaving, kWall));
  bench.cycles_of(0x0F, 10);
  const CellMoment gone = bench.cell.moment();
  EXPECT_EQ(gone.touched_count, 0);
  EXPECT_EQ(gone.point_count, 0);
}

TEST(CellMomentTest, LookingChangesNothing) {
  LiteralCell watched(gantry_cell(), wall_task(), watched_options());
  LiteralCell unwatched;
  for (LiteralCell* bench : {&watched, &unwatched}) {
    ASSERT_TRUE(bench->enable());
    for (int i = 0; i < 300; ++i) {
      bench->move(0, 200, 1);
      if (bench == &watched) (void)bench->cell.moment();
    }
  }
  EXPECT_EQ(watched.log, unwatched.log);
  EXPECT_EQ(truth_json(watched.cell.truth()), truth_json(unwatched.cell.truth()));
}

}  // namespace
}  // namespace tenon::sim
