// Damaged scenes: whatever the bytes, the loader returns a description or throws kaustik::Error.

#include "tests/loader/damage.h"
#include "tests/loader/loader_support.h"

namespace kaustik {
namespace {

const std::string whole = R"(<?xml version="1.0" encoding="utf-8"?>
<!-- every kind of element --><!DOCTYPE scene PUBLIC "" 'no.dtd' [<!ELEMENT scene ANY> <!-- ' -->
  <!ENTITY size "2"><!ENTITY scale '<scale value="&size;"/>'><!ENTITY other SYSTEM "no.xml">]>
<scene version="0.6.0">
  <default name="spp" value="4"/><default name="w" value="$spp$spp"/>
  <integrator type="photonmap"><boolean name="useCache" value="true"/></integrator>
  <camera type="perspective">
    <transform name="toWorld"><translate x="1"/><rotate y="1" angle="20"/>&scale;
      <matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"/>
      <lookAt origin="0, 0, 1" target="0, 0, 0" up="0, 1, 0"/></transform>
    <sampler type="independent"><integer name="sampleCount" value="$w"/></sampler>
  </camera>
  <bsdf type="diffuse" id="white"><rgb name="diffuseReflectance" value="#ff8000"/></bsdf>
  <alias id="white" as="paper"/><![CDATA[ nothing ]]>
  <texture type="bitmap"><float name="uscale" value="2"/><string name="filename" value="ü.png"/></texture>
  <shape type="sphere"><point name="center" x="0" y="0" z="1e-3"/><vector name="v" value="1,2,3"/>
    <ref id="paper"/><emitter type="area"><spectrum name="radiance" value="400:1, 700:2.5"/></emitter>
  </shape>
  <luminaire type="point"><srgb name="intensity" value="0.5"/></luminaire>
</scene>
)";

/// False if the text was refused as it should be.
bool survives(const std::string& text) {
  return is_accepted([&] { return parse(text).scene != nullptr; });
}

TEST(MitsubaFuzz, TheWholeSceneIsSound) { EXPECT_TRUE(survives(whole)); }

TEST(MitsubaFuzz, TruncatedAtEveryByte) {
  const size_t end = whole.find("</scene>") + std::string("</scene>").size();
  for (size_t size = 0; size < end; ++size) {
    SCOPED_TRACE(size);
    EXPECT_FALSE(survives(whole.substr(0, size)));
  }
  EXPECT_TRUE(survives(whole.substr(0, end)));
}

const int rounds = damage_rounds(20000, 2000);

TEST(MitsubaFuzz, FlippedBytes) {
  const int refused = count_refused(whole, 1, rounds, 4, flip_byte, survives);
  EXPECT_GT(refused, rounds / 2);
  EXPECT_LT(refused, rounds);  // comments and white space may change
}

TEST(MitsubaFuzz, ExchangedPieces) {
  count_refused(whole, 2, rounds, 3, exchanged_piece(whole), survives);
}

TEST(MitsubaFuzz, OddLetters) {
  count_refused(whole, 3, rounds, 3, odd_letter("<>\"'/=&;$\\!-[]?#:,. 0e+xX\n"), survives);
}

}  // namespace
}  // namespace kaustik
