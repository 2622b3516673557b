// Files of records count what did not get into them.

#include "shared/system/record_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>

#include "tests/support/full_disk.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace tenon {
namespace {

using tests::refusal;
using tests::ScratchFolder;

TEST(RecordFile, HoldsEveryRecordAndSaysSo) {
  const ScratchFolder folder;
  RecordFile file("log", folder.put("a", "old"));
  file.add("heading\n", 0);
  for (int i = 0; i < 1000; ++i) file.add("record\n");
  file.close();
  EXPECT_TRUE(file.report().whole());
  EXPECT_EQ(file.report().written, 1000U);
  EXPECT_EQ(file.report().lost, 0U);
  EXPECT_EQ(folder.get("a").size(), 8U + 7U * 1000U);
}

TEST(RecordFile, OnAFullDiskWrittenAndLostAreAllThatCame) {
  const ScratchFolder folder;
  RecordReport report;
  {
    const tests::FullDisk full_disk(10'005);
    RecordFile file("can_log", folder.path() / "a");
    for (int i = 0; i < 5000; ++i) file.add("123456789\n");
    file.close();
    report = file.report();
  }
  EXPECT_FALSE(report.whole());
  EXPECT_EQ(report.written, 1000U);  // the last one is torn
  EXPECT_EQ(report.lost, 4000U);
  EXPECT_EQ(loss_text(report), "--can-log " + (folder.path() / "a").string() +
                                   ": 4000 of 5000 records lost (File too large)");
}

TEST(RecordFile, WhatIsNoRegularFileIsRefusedWithoutWaiting) {
  const ScratchFolder folder;
  const std::string pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& name : {pipe, std::string("/dev/full"), folder.path().string()}) {
    EXPECT_EQ(refusal([&] { const RecordFile file("log", name); }),
              name + ": cannot be written: it is not a regular file");
  }
}

}  // namespace
}  // namespace tenon
