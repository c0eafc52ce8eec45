// Damaged scenes: whatever the bytes, the loader returns a description or throws kaustik::Error.
#include "radiance_support.h"
#include "tests/loader/damage.h"

namespace kaustik::radiance_test {
namespace {

const std::string whole_rad = R"(# every kind of statement
void plastic grey 0 0 5 .5 .5 .5 .05 .1
void metal shiny 0 0 5 .9 .8 .7 .9 0
void trans sheet 0 0 7 .8 .8 .8 .1 .05 .5 .25
void glass pane 0 0 3 .96 .9 .9
void dielectric solid 0 0 5 .9 .9 .9 1.5 0
void light lamp 0 0 3 10 10 10
void spotlight beam 0 0 7 9 9 9 40 0 0 -1
void mixfunc mixed 4 grey shiny .5*A1 . 0 1 .5
void alias other grey
grey polygon floor 0 0 30 0 0 0 4 0 0 4 4 0 0 4 0 0 0 0 1 1 0 1 3 0 3 3 0 3 1 0 1 1 0
shiny sphere ball 0 0 4 1 1 1 .5
pane ring r 0 0 8 0 0 1 0 0 1 .1 .5
solid cylinder c 0 0 7 0 0 0 0 0 1 .2
mixed cone k 0 0 8 0 0 0 0 0 1 .2 .1
lamp ring l 0 0 8 0 0 3 0 0 -1 0 .5
beam polygon b 0 0 9 0 0 3 0 1 3 1 0 3
sheet tube t 0 0 7 2 0 0 2 0 1 .2
!genbox other box 1 2 3 -b .1 | xform -a 2 -t 1 0 0 -rx 30
!genrev grey rev 't' '1+t' 4
!genworm grey worm t t*t 0 .1 4 -e 'f(x)=x'
!gensurf grey surf s t 's*t' 3 3 -s
!genprism grey prism 3 0 0 1 0 0 1 -l 0 0 2
!genblinds grey blinds .1 1 1 3 20 -r .2
!gensky 6 21 12:30CET +s -a 48 -o -12
skyfunc glow sky 0 0 4 .9 .9 1.1 0
sky source dome 0 0 4 0 0 1 5
)";

bool survives_rad(const std::string& text) {
  return is_accepted(
      [&] { return parse_radiance(text, "test.rad", "/nowhere", {}).scene != nullptr; });
}

TEST(RadianceFuzz, TheWholeSceneIsSound) { EXPECT_TRUE(survives_rad(whole_rad)); }

TEST(RadianceFuzz, TruncatedAtEveryByte) {
  // What ends between two statements is whole.
  int refused = 0;
  for (size_t size = 0; size < whole_rad.size(); size += 3)
    if (!survives_rad(whole_rad.substr(0, size))) ++refused;
  EXPECT_GT(refused, int(whole_rad.size()) / 6);
}

const int rad_rounds = damage_rounds(800, 100);

TEST(RadianceFuzz, FlippedBytes) {
  const int refused = count_refused(whole_rad, 1, rad_rounds, 4, flip_byte, survives_rad);
  EXPECT_GT(refused, rad_rounds / 3);
  EXPECT_LT(refused, rad_rounds);
}

TEST(RadianceFuzz, ExchangedPieces) {
  count_refused(whole_rad, 2, rad_rounds, 3, exchanged_piece(whole_rad), survives_rad);
}

TEST(RadianceFuzz, OddWords) {
  const std::vector<std::string> odd = {
      "1e308",         "-1e308", "1e-320",   "nan", "inf", "0",      "-1",
      "999999999999",  "void",   "\"",       "'",   "|",   "!xform", "-a",
      "-i 1000000000", "-s 0",   "-s 1e300", "{",   "(",   "^",      "#"};
  // A word in place of another one.
  const auto change = [&](std::string& text, std::mt19937& random) {
    const size_t begin = text.find_first_of(" \n", random() % (text.size() - 1)) + 1;
    const size_t end = std::min(text.find_first_of(" \n", begin), text.size());
    if (begin < end) text.replace(begin, end - begin, odd[random() % odd.size()]);
  };
  count_refused(whole_rad, 3, rad_rounds, 3, change, survives_rad);
}

TEST(RadianceFuzz, Functions) {
  const std::string whole =
      "void brightfunc f 2 'if(Px-.5, A1*sin(3*Py)^2, fnoise3(Px,Py,Pz))' . -rz 20 -s 2 0 1 .5\n"
      "f plastic p 0 0 5 .5 .5 .5 0 0\np polygon q 0 0 9 0 0 0 1 0 0 1 1 0\n";
  const Change change = odd_letter("()*/+-^,.0123456789PxyzAif'{}` ", 120);
  count_refused(whole, 5, rad_rounds / 20, 3, change, survives_rad);
}

TEST(RadianceFuzz, ControlFiles) {
  const std::string whole =
      "materials= a.mat\nscene= a.rad b.rad\nview= x -vtv -vp 0 0 1 -vd 0 1 0 -vh 40\n"
      "RESOLUTION= 64 64\nEXPOSURE= +1\nZONE= I 0 1 0 1 0 1\n";
  std::string printable;
  for (char c = ' '; c < 127; ++c) printable += c;
  count_refused(whole, 4, rad_rounds, 4, odd_letter(printable), survives_rad);
}

}  // namespace
}  // namespace kaustik::radiance_test
