// What came from outside cannot speak to the terminal, nor fill it.

#include "shared/base/printable.h"

#include <gtest/gtest.h>

#include <string>

#include "shared/base/error.h"
#include "shared/config/yaml_value.h"
#include "tests/support/refusal.h"

namespace tenon {
namespace {

using tests::refusal;

TEST(Printable, LeavesTextAndEscapesWhatATerminalObeys) {
  EXPECT_EQ(printable("plain: 3.5 µm, größer, 力, 🙂"),
            "plain: 3.5 µm, größer, 力, 🙂");
  EXPECT_EQ(printable("a\x1B[2Jb\r\n\t\x7F"), "a\\x1B[2Jb\\x0D\\n\\t\\x7F");
  EXPECT_EQ(printable(std::string("\0", 1)), "\\x00");
  EXPECT_EQ(printable("\xC2\x9B"), "\\xC2\\x9B");  // 8-bit control
  EXPECT_EQ(printable("\xC0\xAF \xED\xA0\x80 \xF5"), "\\xC0\\xAF \\xED\\xA0\\x80 \\xF5");
  EXPECT_EQ(printable("a\xE2\x80\xA8"
                      "b\xE2\x80\xAE"
                      "c\xE2\x80\xA6"),
            "a\\xE2\\x80\\xA8"
            "b\\xE2\\x80\\xAE"
            "c\xE2\x80\xA6");
  EXPECT_EQ(printable("cut \xE5\x8A"), "cut \\xE5\\x8A");
}

TEST(Shortened, KeepsBothEndsAndSaysWhatIsMissing) {
  EXPECT_EQ(shortened("short", 5), "short");
  EXPECT_EQ(shortened("0123456789abcdef", 9), "012345... (7 bytes) ...def");
  EXPECT_EQ(shortened("ééééééé", 6), "éé... (8 bytes) ...é");
}

TEST(InputError, IsOneShortLineWhateverItNames) {
  EXPECT_STREQ(InputError("task\x1B]0;x\x07.yaml: no\nfile").what(),
               "task\\x1B]0;x\\x07.yaml: no\\nfile");
  std::string endless(100'000, 'x');
  endless += "; do this";
  const std::string message = InputError(endless).what();
  EXPECT_LT(message.size(), 2100U);
  EXPECT_TRUE(message.ends_with("; do this")) << message;
}

TEST(YamlValue, ALongValueIsShownByItsEnds) {
  const std::string text = "a: 1" + std::string(100'000, '0') + "\n";
  const std::string line = refusal([&] {
    const config::Map map(config::Value::parse("t.yaml", text), {"a"});
    (void)map.number("a", {0.0, 1.0});
  });
  EXPECT_LT(line.size(), 200U) << line;
  EXPECT_TRUE(line.starts_with("t.yaml:1: a = 1000")) << line;
  EXPECT_TRUE(line.ends_with("must be a number in [0, 1]")) << line;
}

}  // namespace
}  // namespace tenon
