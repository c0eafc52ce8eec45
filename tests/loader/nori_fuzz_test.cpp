// Damaged files of Nori: whatever the bytes, the reader returns a description or throws
// kaustik::Error.

#include "tests/loader/damage.h"
#include "tests/loader/nori_support.h"

namespace kaustik::nori {
namespace {

const std::string whole_nori = R"(<?xml version="1.0" encoding="utf-8"?>
<scene>
<integrator type="photonmapper"><integer name="photonCount" value="100"/></integrator>
<sampler type="independent"><integer name="sampleCount" value="32"/></sampler>
<camera type="perspective"><transform name="toWorld"><scale value="-1,1,1"/>
<lookat target="0, 0.9, 4.4" origin="0, 0.9, 5.4" up="0, 1, 0"/></transform>
<float name="fov" value="27.7"/><integer name="width" value="8"/>
<rfilter type="gaussian"><float name="radius" value="2"/></rfilter></camera>
<mesh type="obj"><string name="filename" value="none.obj"/><transform name="toWorld">
<rotate axis="1,0,0" angle="30"/><translate value="1 2 3"/>
<matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"/></transform>
<bsdf type="diffuse"><texture type="checkerboard_color" name="albedo">
<vector name="scale" value="0.1,0.2"/></texture></bsdf>
<emitter type="area"><color name="radiance" value="15 15 15"/></emitter></mesh>
<mesh type="sphere"><point name="center" value="1 2 3"/><bsdf type="microfacet">
<color name="kd" value="0.1 0.2 0.3"/><float name="intIOR" value="1.5"/></bsdf></mesh>
<emitter type="spot"><point name="origin" value="0 1 0"/><point name="lookat" value="0 0 0"/>
<color name="power" value="5"/><float name="TotalWidth" value="20"/></emitter>
</scene>
)";

const std::string whole_nori_test = R"(<test type="ttest">
<string name="references" value="0.2, 0.3"/><string name="angles" value="0, 80"/>
<bsdf type="microfacet"><float name="alpha" value="0.1"/></bsdf></test>
)";

/// False if the text was refused as it should be.
bool survives_nori(const std::string& text, const TemporaryFolder* folder = nullptr) {
  return is_accepted([&] {
    if (folder) return !read_nori_tests(folder->write("test.xml", text)).empty();
    return parse_nori_text(text).scene != nullptr;
  });
}

const int nori_rounds = damage_rounds(3000, 500);

TEST(NoriFuzz, TheWholeFilesAreSound) {
  const TemporaryFolder folder;
  EXPECT_TRUE(survives_nori(whole_nori));
  EXPECT_TRUE(survives_nori(whole_nori_test, &folder));
}

TEST(NoriFuzz, TruncatedAtEveryByte) {
  const TemporaryFolder folder;
  for (size_t size = 0; size + 1 < whole_nori.size(); ++size)
    EXPECT_FALSE(survives_nori(whole_nori.substr(0, size))) << size;
  for (size_t size = 0; size < whole_nori_test.size(); ++size)
    survives_nori(whole_nori_test.substr(0, size), &folder);
}

TEST(NoriFuzz, FlippedBytes) {
  const int refused = count_refused(whole_nori, 1, nori_rounds, 4, flip_byte,
                                    [](const std::string& text) { return survives_nori(text); });
  EXPECT_GT(refused, nori_rounds / 10);
  EXPECT_LT(refused, nori_rounds);
}

TEST(NoriFuzz, ExchangedPiecesAndNumbers) {
  const Change words = exchanged_word({"0", "-1", "1e30", "1e-30", "nan", "99999999999", "type",
                                       "<", "/>", "\"", "integer", "string"});
  const TemporaryFolder folder;
  count_refused(whole_nori, 2, nori_rounds * 9 / 10, 3,
                either(exchanged_piece(whole_nori, 7), words),
                [](const std::string& text) { return survives_nori(text); });
  count_refused(whole_nori_test, 3, nori_rounds / 10, 3,
                either(exchanged_piece(whole_nori_test, 7), words),
                [&](const std::string& text) { return survives_nori(text, &folder); });
}

}  // namespace
}  // namespace kaustik::nori
