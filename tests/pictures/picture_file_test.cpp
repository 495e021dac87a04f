#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "ductile/files.h"
#include "ductile/picture.h"

namespace {
using namespace ductile;
namespace fs = std::filesystem;

constexpr auto square =
    R"(<svg xmlns="http://www.w3.org/2000/svg" width="30" height="20"><rect width="9" height="9"/></svg>)";

class PictureFile : public testing::Test {
 protected:
  PictureFile() {
    std::string name = (fs::temp_directory_path() / "ductile.XXXXXX").string();
    folder = ::mkdtemp(name.data());
  }
  ~PictureFile() override { fs::remove_all(folder); }
  fs::path folder;
};

TEST_F(PictureFile, AnSvgIsWrittenAsItIs) {
  write_picture(folder / "a.svg", square);
  EXPECT_EQ(read_text(folder / "a.svg"), square);
}

TEST_F(PictureFile, APngHasTwoPixelsPerPx) {
  if (std::system("rsvg-convert --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no rsvg-convert";
  write_picture(folder / "it's a \"picture\".png", square);
  const std::string png = read_text(folder / "it's a \"picture\".png");
  ASSERT_GT(png.size(), 24u);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  const auto size = [&](std::size_t at) {  // big-endian, in the first chunk
    return (static_cast<unsigned char>(png[at + 2]) << 8) + static_cast<unsigned char>(png[at + 3]);
  };
  EXPECT_EQ(size(16), 60);
  EXPECT_EQ(size(20), 40);
}

TEST_F(PictureFile, WithoutRsvgConvertAPngIsRefusedWithARemedy) {
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", folder.c_str(), 1);
  EXPECT_THROW(
      {
        try {
          write_picture(folder / "a.png", square);
        } catch (const InvalidInput& error) {
          EXPECT_NE(std::string(error.what()).find("librsvg2-bin"), std::string::npos) << error.what();
          throw;
        }
      },
      InvalidInput);
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_FALSE(fs::exists(folder / "a.png"));
}

TEST_F(PictureFile, OtherNamesAreRefused) {
  EXPECT_THROW(write_picture(folder / "a.jpg", square), InvalidInput);
  EXPECT_THROW(write_picture(folder / "a", square), InvalidInput);
  EXPECT_TRUE(fs::is_empty(folder));
}
}  // namespace
