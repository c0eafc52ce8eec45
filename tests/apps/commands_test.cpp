// What the commands beside `render` make of good input.

#include "kaustik/image/image_io.h"
#include "kaustik/image/metrics.h"
#include "kaustik/integrator/foreign_integrators.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/photon/photon_file.h"
#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class Commands : public ProgramTest {
 protected:
  Commands() { write("scene.xml", small_scene()); }
  bool same_pixels(const std::string& a, const std::string& b) const {
    return compare_images(read_image(path(a)), read_image(path(b))).mse == 0;
  }
};

/// The tables of all registries.
std::vector<const TypeInfo*> registered_types() {
  std::vector<const TypeInfo*> types;
  for (const auto& row : camera_types()) types.push_back(&row.info);
  for (const auto& row : film_types()) types.push_back(&row.info);
  for (const auto& row : integrator_types()) types.push_back(&row.info);
  for (const auto& row : foreign_integrators()) types.push_back(&row.info);
  for (const auto& row : shape_types()) types.push_back(&row.info);
  for (const auto& row : bsdf_types()) types.push_back(&row.info);
  for (const auto& row : texture_types()) types.push_back(&row.info);
  for (const auto& row : light_types()) types.push_back(&row.info);
  for (const auto& row : medium_types()) types.push_back(&row.info);
  for (const auto& row : phase_function_types()) types.push_back(&row.info);
  for (const auto& row : volume_types()) types.push_back(&row.info);
  for (const auto& row : filter_types()) types.push_back(&row.info);
  for (const TypeInfo& info : sampler_infos()) types.push_back(&info);
  return types;
}

TEST_F(Commands, HelpKnowsEveryTypeAndParameter) {
  const std::string all = run_well({"help"}).out;
  size_t index = 0;
  for (const TypeInfo* info : registered_types()) {
    SCOPED_TRACE(info->family + " " + info->name);
    EXPECT_TRUE(contains(all, "  " + info->name + " "));
    EXPECT_TRUE(contains(all, info->sentence));
    // One way prints them all. With sanitizers the program takes long to start.
    if (slow_build && index++ % 8 != 0) continue;
    const std::string text = run_well({"help", info->name}).out;
    EXPECT_TRUE(contains(text, info->family + " type=\"" + info->name + "\""));
    for (const Parameter& parameter : info->parameters) {
      EXPECT_TRUE(contains(text, parameter.name)) << parameter.name;
      EXPECT_TRUE(parameter.no_effect || contains(text, parameter.sentence)) << parameter.name;
    }
  }
}

TEST_F(Commands, HelpShowsDefaultsRangesAndUnits) {
  const std::string text = run_well({"help", "photonmap"}).out;
  EXPECT_TRUE(contains(text, "caustic_neighbors (integer, default 60, 0 … 100000)")) << text;
  EXPECT_TRUE(contains(text, "One of: constant, cone, epanechnikov")) << text;
  EXPECT_TRUE(contains(run_well({"help", "rfilter"}).out, "type=\"tent\""));
  for (const std::string command : {"render", "photons", "compare", "denoise", "tonemap", "info"})
    EXPECT_TRUE(contains(run_well({command, "--help"}).out, command));
  EXPECT_FALSE(run_well({"--version"}).out.empty());
}

TEST_F(Commands, CompareOfEqualImages) {
  run_well({"render", "scene.xml", "-q", "--spp", "2", "-o", "a.exr", "-o", "b.exr"});
  const RunResult result = run_well({"compare", "a.exr", "b.exr", "-o", "difference.png"});
  EXPECT_TRUE(contains(result.out, "mse                  0\n")) << result.out;
  EXPECT_TRUE(contains(result.out, "relative_mse         0\n")) << result.out;
  EXPECT_TRUE(contains(result.out, "mean_ratio           1.000000 1.000000 1.000000"))
      << result.out;
  EXPECT_EQ(read_image(path("difference.png")).width(), 24);
}

TEST_F(Commands, CompareOfDifferentImages) {
  run_well({"render", "scene.xml", "-q", "--spp", "2", "-o", "a.exr"});
  run_well({"render", "scene.xml", "-q", "--spp", "2", "-o", "b.exr", "--set",
            "integrator.components=direct"});
  const RunResult result = run_well({"compare", "b.exr", "a.exr"});
  EXPECT_FALSE(contains(result.out, "mse                  0\n")) << result.out;
  EXPECT_TRUE(contains(result.out, "mean_ratio           0.")) << result.out;
  EXPECT_TRUE(contains(result.out, "reference_noise      0.")) << result.out;
  run_well({"render", "scene.xml", "-q", "--spp", "2", "-o", "c.exr", "-D", "size=8"});
  const RunResult sizes = run({"compare", "c.exr", "a.exr"});
  EXPECT_EQ(sizes.exit_code, 2) << sizes.err;
  EXPECT_TRUE(contains(sizes.err, "remedy: ")) << sizes.err;
}

TEST_F(Commands, DenoiseMakesThePictureThatRenderMakes) {
  run_well({"render", "scene.xml", "-q", "--passes", "1", "--spp", "4", "--float", "-o", "a.exr"});
  run_well({"denoise", "a.exr", "--float", "-o", "b.exr"});
  run_well({"render", "scene.xml", "-q", "--passes", "1", "--spp", "4", "--float", "--denoise",
            "-o", "c.exr"});
  EXPECT_TRUE(same_pixels("b.exr", "c.exr"));
  EXPECT_FALSE(same_pixels("a.exr", "b.exr"));
  EXPECT_NE(read_image(path("c.exr")).find_metadata("denoised"), nullptr);
  EXPECT_EQ(read_image(path("a.exr")).find_metadata("denoised"), nullptr);
  run_well({"render", "scene.xml", "-q", "-o", "truth.exr", "--passes", "64", "--spp", "256",
            "--seed", "2"});
  const auto error = [&](const char* image) {
    return compare_images(read_image(path(image)), read_image(path("truth.exr"))).relative_mse;
  };
  EXPECT_LT(error("b.exr"), error("a.exr"));
}

TEST_F(Commands, DenoiseTakesCheckpoints) {
  run_well({"render", "scene.xml", "-q", "--passes", "4", "--spp", "16", "--float", "--checkpoint",
            "a.kpt", "-o", "a.exr"});
  run_well({"denoise", "a.kpt", "--float", "-o", "b.exr"});
  run_well({"denoise", "a.exr", "--float", "-o", "c.exr"});
  EXPECT_TRUE(same_pixels("b.exr", "c.exr"));
  EXPECT_FALSE(same_pixels("a.exr", "b.exr"));
  const Image smooth = read_image(path("b.exr"));
  EXPECT_NE(smooth.find_metadata("denoised"), nullptr);
  EXPECT_GE(smooth.find_channel("denoised_error.G"), 0);
}

TEST_F(Commands, WhatCannotBeDenoised) {
  run_well({"render", "scene.xml", "-q", "--spp", "2", "-o", "a.pfm"});
  const RunResult flat = run({"denoise", "a.pfm", "-o", "b.exr"});
  EXPECT_EQ(flat.exit_code, 2) << flat.err;
  EXPECT_TRUE(contains(flat.err, "lacks the layers") && contains(flat.err, "remedy: ")) << flat.err;
  EXPECT_TRUE(contains(flat.err, "a.pfm")) << flat.err;
  run_well({"render", "scene.xml", "-q", "--spp", "2", "--denoise", "-o", "smooth.exr"});
  const RunResult twice = run({"denoise", "smooth.exr", "-o", "b.exr"});
  EXPECT_EQ(twice.exit_code, 2) << twice.err;
  EXPECT_TRUE(contains(twice.err, "smooth.exr") && contains(twice.err, "denoised before"))
      << twice.err;
  EXPECT_FALSE(std::filesystem::exists(path("b.exr")));
  // A picture is not lost for it.
  const RunResult lamps = run_well({"render", "scene.xml", "-q", "--spp", "2", "--denoise", "-o",
                                    "c.exr", "--set", "integrator.components=emission"});
  EXPECT_TRUE(contains(lamps.err, "it is not denoised")) << lamps.err;
  EXPECT_EQ(read_image(path("c.exr")).width(), 24);
}

TEST_F(Commands, TonemapMakesThePictureThatRenderMakes) {
  run_well({"render", "scene.xml", "-q", "--spp", "8", "--float", "-o", "a.exr", "-o", "a.png"});
  run_well({"tonemap", "a.exr", "-o", "b.png"});
  EXPECT_TRUE(same_pixels("a.png", "b.png"));
  run_well({"tonemap", "a.exr", "-o", "c.png", "--operator", "linear", "--exposure", "1"});
  EXPECT_FALSE(same_pixels("a.png", "c.png"));
  run_well({"tonemap", "a.exr", "-o", "d.png", "--layer", "direct"});
  EXPECT_FALSE(same_pixels("a.png", "d.png"));
  const RunResult unknown = run({"tonemap", "a.exr", "-o", "e.png", "--layer", "drect"});
  EXPECT_EQ(unknown.exit_code, 2) << unknown.err;
  EXPECT_TRUE(contains(unknown.err, "direct")) << unknown.err;
}

TEST_F(Commands, InfoTellsWhatIsThere) {
  const std::string text = run_well({"info", "scene.xml", "-D", "size=77"}).out;
  EXPECT_TRUE(contains(text, "shapes     4 (4 triangles, 2 analytic or procedural)")) << text;
  EXPECT_TRUE(contains(text, "77 × 77 pixels")) << text;
  EXPECT_TRUE(contains(text, "surface 'lamp', 16.08")) << text;  // 8 π 0.64 W
  EXPECT_TRUE(contains(text, "field of view 40° × 40°")) << text;
  EXPECT_FALSE(contains(text, "warning")) << text;
}

TEST_F(Commands, InfoTellsWhereLampsAndSunAre) {
  SceneParts parts;
  parts.inside =
      "<emitter type=\"sunsky\"><float name=\"latitude\" value=\"52.52\"/>"
      "<float name=\"longitude\" value=\"13.4\"/><float name=\"timezone\" value=\"2\"/>"
      "<integer name=\"year\" value=\"2026\"/><integer name=\"month\" value=\"6\"/>"
      "<integer name=\"day\" value=\"21\"/><float name=\"hour\" value=\"9\"/>"
      "<transform name=\"to_world\"><rotate z=\"1\" angle=\"180\"/></transform></emitter>"
      "<shape type=\"disk\"><emitter type=\"area\"/></shape>";
  write("day.xml", scene_with(parts));
  const std::string text = run_well({"info", "day.xml"}).out;
  EXPECT_TRUE(contains(
      text, "\nsun        35.3° high, 97.0° from north by east; toward -0.099, 0.81, 0.577\n"))
      << text;
  EXPECT_TRUE(contains(text, " shape 'disk' on line 2, ")) << text;
  EXPECT_TRUE(contains(text, " at 0, 0, 2, ")) << text;
}

TEST_F(Commands, InfoWarnsOfWhatCannotWork) {
  const auto warned = [&](const SceneParts& parts, const std::string& warning) {
    SCOPED_TRACE(warning);
    write("odd.xml", scene_with(parts));
    const RunResult result = run_well({"info", "odd.xml"});
    EXPECT_TRUE(contains(result.out, "warning: ")) << result.out;
    EXPECT_TRUE(contains(result.out, warning)) << result.out;
  };
  warned({"", true, true, false}, "the scene has no light");
  warned({"<emitter type=\"point\"><rgb name=\"intensity\" value=\"0\"/></emitter>", true, true,
          false},
         "has no power");
  Image bright(2, 2, {"R", "G", "B"});
  for (int i = 0; i < 12; ++i) bright.at(i / 3 % 2, i / 6, i % 3) = 1.5f;
  write_image(bright, path("bright.pfm"));
  warned({"<shape type=\"sphere\" id=\"ball\"><bsdf type=\"diffuse\">"
          "<texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" "
          "value=\"bright.pfm\"/></texture></bsdf></shape>"},
         "ball reflects 1.5 times what arrives");
  warned({"<sensor type=\"perspective\"><transform name=\"to_world\">"
          "<lookat origin=\"0,0,5\" target=\"0,0,9\" up=\"0,1,0\"/></transform></sensor>",
          false},
         "the camera sees no shape");
  warned({"<shape type=\"sphere\"><emitter type=\"area\"><boolean name=\"visible\" "
          "value=\"false\"/></emitter></shape>",
          true, false},
         "the scene has no shape");
  // Fog alone can be seen, though no surface is met.
  write("fog.xml", scene_with({"<shape type=\"cube\"><bsdf type=\"null\"/><medium "
                               "name=\"interior\" type=\"homogeneous\"/></shape>",
                               true, false}));
  EXPECT_FALSE(contains(run_well({"info", "fog.xml"}).out, "sees no shape"));
  warned(
      {"<sensor type=\"perspective\"><integer name=\"shutter_open\" value=\"3\"/></sensor>", false},
      "without effect here: 'shutter_open' of sensor 'perspective'");
}

TEST_F(Commands, InfoTellsHowTheSceneIsRendered) {
  const std::string own = run_well({"info", "scene.xml"}).out;
  EXPECT_TRUE(contains(own, "integrator path\n")) << own;
  EXPECT_TRUE(contains(own, "sampler    Sobol points, scrambled after Owen")) << own;
  write("bare.xml", scene_with({}));
  const std::string bare = run_well({"info", "bare.xml"}).out;
  EXPECT_TRUE(contains(bare, "integrator auto, since the scene names none\n")) << bare;
  EXPECT_TRUE(contains(bare, "samples    4 per pixel in each of 16 passes")) << bare;
  write("old.xml", R"(<scene version="0.6.0">
<integrator type="photonmapper">
<integer name="lookupSize" value="60"/>
<integer name="granularity" value="200"/>
</integrator>
<sensor type="perspective"><transform name="toWorld"><lookAt origin="0, 0, 4" target="0, 0, 0"
up="0, 1, 0"/></transform><sampler type="halton"><integer name="sampleCount" value="8"/></sampler>
<film type="hdrfilm"><string name="fileFormat" value="openexr"/></film></sensor>
<shape type="sphere"/><emitter type="point"><point name="position" x="0" y="9" z="9"/></emitter>
</scene>)");
  const std::string old = run_well({"info", "old.xml"}).out;
  EXPECT_TRUE(contains(old, "integrator photonmap, for the scene's photonmapper\n")) << old;
  EXPECT_TRUE(contains(old, "samples    8 per pixel, as the scene says\n")) << old;
  EXPECT_TRUE(contains(old, "scrambled after Owen, for the scene's halton\n")) << old;
  EXPECT_TRUE(contains(old, "picture    768 × 576 pixels\n")) << old;
  EXPECT_TRUE(contains(old, "without effect here: 'fileFormat' of film 'hdrfilm' (old.xml:8:22)\n"))
      << old;
  EXPECT_TRUE(contains(
      old, "without effect here: 'granularity' of integrator 'photonmapper' (old.xml:4:1)\n"))
      << old;
  // What another method has no use for is called as in the file, too.
  const RunResult other =
      run_well({"render", "old.xml", "--integrator", "path", "--spp", "1", "--set", "film.width=4",
                "--set", "film.height=4", "-o", "old.pfm"});
  EXPECT_TRUE(contains(other.err, "of its 'photonmapper': lookupSize\n")) << other.err;
}

TEST_F(Commands, InfoTellsWhatAPictureHolds) {
  run_well(
      {"render", "scene.xml", "-D", "size=6", "--spp", "2", "-q", "-o", "a.exr", "-o", "a.png"});
  const std::string exr = run_well({"info", "a.exr"}).out;
  EXPECT_TRUE(contains(exr, "picture    6 × 6 pixels\n")) << exr;
  EXPECT_TRUE(contains(exr, "layer      R, G, B\n")) << exr;
  EXPECT_TRUE(contains(exr, "layer      direct: R, G, B\n")) << exr;
  EXPECT_TRUE(contains(exr, "metadata   integrator: path\n")) << exr;
  EXPECT_TRUE(contains(run_well({"info", "a.png"}).out, "picture    6 × 6 pixels\n"));
  write("none.exr", "?");
  EXPECT_EQ(run({"info", "none.exr"}).exit_code, 2);
}

TEST_F(Commands, NoIntegratorIsAnotherNameOfItself) {
  for (const ForeignIntegrator& foreign : foreign_integrators()) {
    const std::string& sentence = foreign.info.sentence;
    const size_t also = sentence.find("Also: ");
    const std::string list = also == std::string::npos ? "" : ", " + sentence.substr(also + 6);
    EXPECT_FALSE(contains(list, ", " + foreign.native + ",") ||
                 contains(list, ", " + foreign.native + "."))
        << sentence;
    if (foreign.info.name == foreign.native) {
      EXPECT_FALSE(contains(sentence, "Another renderer's name")) << sentence;
    }
  }
}

TEST_F(Commands, InfoWarnsOfACameraInAWall) {
  const auto wall = [&](const std::string& bsdf, double distance) {
    write("wall.xml",
          scene_with({"<shape type=\"cube\" id=\"wall\"><transform name=\"to_world\">"
                      "<scale value=\"" +
                      std::to_string(distance) + "\"/><translate y=\"-4\" z=\"2\"/></transform>" +
                      bsdf + "</shape>"}));
    return run_well({"info", "wall.xml"}).out;
  };
  EXPECT_TRUE(contains(wall("", 0.2), "inside a wall")) << wall("", 0.2);
  EXPECT_TRUE(contains(wall("", 0.2), "'wall'"));
  EXPECT_FALSE(contains(wall("<bsdf type=\"dielectric\"/>", 0.2), "inside a wall"));
  EXPECT_FALSE(contains(wall("<bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf>", 0.2),
                        "inside a wall"));
  EXPECT_TRUE(contains(wall("<bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf>", 1e-5),
                       "inside a wall"));
}

TEST_F(Commands, PhotonsTellsWhatBecameOfThem) {
  const RunResult result =
      run_well({"photons", "scene.xml", "-o", "map.kpm", "--set", "integrator.caustic_photons=3000",
                "--set", "integrator.global_photons=5000", "--seed", "4", "-l", "7"});
  const StoredPhotons stored = read_photon_file(path("map.kpm"));
  EXPECT_EQ(stored.settings.maximum_events, 7);
  EXPECT_EQ(stored.scene, "scene.xml");
  EXPECT_EQ(stored.seed, 4u);
  EXPECT_EQ(stored.settings.caustic_photons, 3000u);
  EXPECT_GT(stored.maps.caustic.size(), 100u);
  ASSERT_EQ(stored.maps.global_report.lights.size(), 1u);
  const LightCounts& counts = stored.maps.global_report.lights[0];
  EXPECT_EQ(counts.emitted, 5000u);
  EXPECT_EQ(counts.nothing + counts.escaped + counts.absorbed + counts.too_long + counts.stopped,
            5000u);
  const LightCounts& caustic = stored.maps.caustic_report.lights[0];
  EXPECT_EQ(
      caustic.nothing + caustic.escaped + caustic.absorbed + caustic.too_long + caustic.stopped,
      caustic.emitted);
  EXPECT_GT(caustic.stopped, 0u);
  for (const char* part : {"caustic map: ", "global map: ", "bytes per photon", "emitted", "stored",
                           "nothing", "escaped", "absorbed", "too long", "stopped", "0: lamp"})
    EXPECT_TRUE(contains(result.out, part)) << part << " is missing in\n" << result.out;
  EXPECT_TRUE(contains(result.out, std::to_string(counts.absorbed))) << result.out;
}

TEST_F(Commands, PhotonsAreTheSameForAnyNumberOfThreads) {
  const auto trace = [&](const std::string& threads, const std::string& seed,
                         const std::string& file) {
    run_well({"photons", "scene.xml", "--threads", threads, "--seed", seed, "-o", file, "--set",
              "integrator.caustic_photons=9000"});
    return contents(file);
  };
  const std::string one = trace("1", "1", "a.kpm");
  EXPECT_TRUE(one == trace("2", "1", "b.kpm"));
  EXPECT_FALSE(one == trace("2", "2", "c.kpm"));
}

TEST_F(Commands, PhotonsExplainsEmptyMaps) {
  write("plain.xml", scene_with({}));
  const RunResult plain = run_well({"photons", "plain.xml", "-o", "map.kpm"});
  EXPECT_TRUE(contains(plain.err, "no specular object")) << plain.err;
  EXPECT_TRUE(contains(plain.err, "the global map is empty: no surface sends")) << plain.err;
  const RunResult none =
      run_well({"photons", "scene.xml", "-o", "map.kpm", "--set", "integrator.caustic_photons=0"});
  EXPECT_TRUE(contains(none.err, "no caustic photons are asked for")) << none.err;
  write("dark.xml", scene_with({"", true, true, false}));
  const RunResult dark = run_well({"photons", "dark.xml", "-o", "map.kpm"});
  EXPECT_TRUE(contains(dark.err, "the scene has no light")) << dark.err;
  EXPECT_TRUE(read_photon_file(path("map.kpm")).maps.global.empty());
}

TEST_F(Commands, CtrlCLeavesNoHalfPhotonMap) {
  RunOptions interrupt;
  interrupt.interrupt_at = "tracing photons";
  interrupt.interrupt_delay_s = 0.2;
  const RunResult result = run(
      {"photons", "scene.xml", "-o", "map.kpm", "--set", "integrator.caustic_photons=300000000"},
      interrupt);
  EXPECT_EQ(result.exit_code, 75) << result.err;
  EXPECT_TRUE(contains(result.err, "cancelled")) << result.err;
  EXPECT_EQ(files(), (std::vector<std::string>{"scene.xml"}));
}

TEST_F(Commands, RenderNamesEveryIntegrator) {
  const std::string help = run_well({"render", "--help"}).out;
  // Other renderers' names of the same methods are left out.
  for (const IntegratorType& type : integrator_types())
    EXPECT_TRUE(contains(help, type.info.name)) << type.info.name;
  EXPECT_FALSE(contains(help, "volpath"));
}

}  // namespace
}  // namespace kaustik::test
