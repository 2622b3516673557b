// Files are written whole or not at all.

#include "shared/config/files.h"

#include <gtest/gtest.h>

#include "shared/config/load.h"
#include "shared/plan/codec.h"
#include "tests/shared/example_plans.h"
#include "tests/support/full_disk.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace tenon {
namespace {

using tests::FullDisk;
using tests::refusal;
using tests::ScratchFolder;

TEST(WriteFile, ReplacesTheFileAndLeavesNothingElse) {
  const ScratchFolder folder;
  folder.put("a.txt", "old");
  write_file(folder.path() / "a.txt", std::string("new\0text", 8));
  EXPECT_EQ(folder.get("a.txt"), std::string("new\0text", 8));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.txt"});
}

TEST(WriteFile, LeavesTheOldFileWholeWhenTheDiskIsFull) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder.put("a.txt", "old");
  std::string message;
  {
    const FullDisk full_disk(1000);
    // Not bad input, which would be refused with another exit status.
    try {
      write_file(file, std::string(5000, 'x'));
    } catch (const InputError& error) {
      ADD_FAILURE() << error.what();
    } catch (const std::runtime_error& error) {
      message = error.what();
    }
  }
  EXPECT_EQ(message, file.string() + ": cannot be written: File too large");
  EXPECT_EQ(folder.get("a.txt"), "old");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.txt"});
}

TEST(WriteFile, RefusesFoldersAndDevices) {
  const ScratchFolder folder;
  EXPECT_EQ(refusal([&] { write_file(folder.path(), "text"); }),
            folder.path().string() + ": cannot be written: it is not a regular file");
  EXPECT_EQ(refusal([] { write_file("/dev/null", "text"); }),
            "/dev/null: cannot be written: it is not a regular file");
  const std::filesystem::path nowhere = folder.path() / "no" / "a.txt";
  EXPECT_EQ(refusal([&] { write_file(nowhere, "text"); }),
            nowhere.string() + ": cannot be written: No such file or directory");
}

TEST(LoadPlan, ReadsWhatWriteFileWrote) {
  const ScratchFolder folder;
  write_file(folder.path() / "a.tnp", encode_plan(tests::documented_plan()));
  const Plan plan = load_plan(folder.path() / "a.tnp");
  EXPECT_EQ(encode_plan(plan), encode_plan(tests::documented_plan()));
}

TEST(LoadPlan, NamesFileByteFieldAndReason) {
  const ScratchFolder folder;
  std::vector<std::uint8_t> bytes = encode_plan(tests::documented_plan());
  const std::filesystem::path file = folder.path() / "a.tnp";
  const auto message = [&] {
    write_file(file, bytes);
    return refusal([&] { (void)load_plan(file); });
  };
  bytes[4] = 5;
  EXPECT_EQ(message(), file.string() +
                           ": byte 4, version: another version of the format (this program reads "
                           "versions 1 to 4); plan again");
  bytes[4] = 1;
  bytes[100] ^= 1;
  EXPECT_EQ(
      message(),
      file.string() + ": byte 392, checksum: the checksum does not match: damaged; plan again");
  EXPECT_EQ(refusal([&] { (void)load_plan(folder.path() / "none.tnp"); }),
            (folder.path() / "none.tnp").string() + ": cannot be read: No such file or directory");
}

}  // namespace
}  // namespace tenon
