#include "kaustik/render/program_version.h"

#include <gtest/gtest.h>

#include "kaustik/base/error.h"

namespace kaustik {
namespace {

TEST(ProgramVersion, OthersAreRefused) {
  EXPECT_NO_THROW(check_program("a.kpt", "1.2.3", "1.2.3"));
  try {
    check_program("a.kln", "1.2.3", "1.2.4");
    ADD_FAILURE() << "was not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    const std::string text = error.what();
    for (const char* part :
         {"a.kln", "by Kaustik 1.2.3, this program is 1.2.4", "use that version"})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace kaustik
