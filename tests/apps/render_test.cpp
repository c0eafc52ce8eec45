// What `render` makes of good input.

#include "kaustik/image/image_io.h"
#include "kaustik/image/metrics.h"
#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

constexpr const char* photonmap_options =
    "<integrator type=\"photonmap\"><integer name=\"global_photons\" value=\"3000\"/>"
    "<integer name=\"caustic_photons\" value=\"3000\"/>"
    "<integer name=\"samples_per_pass\" value=\"1\"/>"
    "<integer name=\"cache_samples\" value=\"32\"/></integrator>";

class Render : public ProgramTest {
 protected:
  Render() {
    write("path.xml", small_scene());
    write("lighttracer.xml", small_scene("<integrator type=\"lighttracer\"/>"));
    write("photonmap.xml", small_scene(photonmap_options));
  }
  /// Sum of the red channel.
  double brightness(const std::string& image) const {
    const Image read = read_image(path(image));
    double sum = 0;
    for (int y = 0; y < read.height(); ++y)
      for (int x = 0; x < read.width(); ++x) sum += read.at(x, y, 0);
    return sum;
  }
  double mse(const std::string& a, const std::string& b) const {
    return compare_images(read_image(path(a)), read_image(path(b))).mse;
  }
};

TEST_F(Render, ThreadsMakeNoDifferenceToTheFiles) {
  for (const std::string integrator : {"path", "lighttracer", "photonmap"}) {
    SCOPED_TRACE(integrator);
    const auto render = [&](const std::string& threads, const std::string& seed,
                            const std::string& name) {
      run_well({"render", integrator + ".xml", "-q", "--reproducible", "--passes", "3", "--spp",
                "6", "--threads", threads, "--seed", seed, "-o", name + ".exr", "-o", name + ".png",
                "-o", name + ".tif"});
    };
    render("1", "5", "one");
    render("2", "5", "two");
    render("2", "6", "other");
    for (const std::string extension : {".exr", ".png", ".tif"}) {
      EXPECT_FALSE(contents("one" + extension).empty());
      EXPECT_TRUE(contents("one" + extension) == contents("two" + extension)) << extension;
      EXPECT_FALSE(contents("one" + extension) == contents("other" + extension)) << extension;
    }
    EXPECT_GT(brightness("one.exr"), 0);
    EXPECT_GT(mse("one.exr", "other.exr"), 0);
  }
}

TEST_F(Render, OnlyWithoutReproducibleTheTimeIsWritten) {
  run_well({"render", "path.xml", "-q", "--spp", "1", "-o", "a.exr"});
  run_well({"render", "path.xml", "-q", "--spp", "1", "--reproducible", "-o", "b.exr"});
  EXPECT_NE(read_image(path("a.exr")).find_metadata("render_seconds"), nullptr);
  EXPECT_EQ(read_image(path("b.exr")).find_metadata("render_seconds"), nullptr);
}

TEST_F(Render, MetadataSaysHowThePictureCameAbout) {
  run_well(
      {"render", "path.xml", "-q", "--passes", "2", "--spp", "6", "--seed", "9", "-o", "a.exr"});
  const Image image = read_image(path("a.exr"));
  const auto text = [&](const char* key) {
    const MetadataValue* value = image.find_metadata(key);
    const auto* string = value ? std::get_if<std::string>(value) : nullptr;
    return string ? *string : std::string();
  };
  const auto number = [&](const char* key) {
    const MetadataValue* value = image.find_metadata(key);
    const auto* integer = value ? std::get_if<int64_t>(value) : nullptr;
    return integer ? *integer : int64_t{-1};
  };
  EXPECT_TRUE(contains(text("software"), "Kaustik "));
  EXPECT_EQ(text("scene"), "path.xml");
  EXPECT_EQ(text("integrator"), "path");
  EXPECT_EQ(number("seed"), 9);
  EXPECT_EQ(number("passes"), 2);
  EXPECT_EQ(number("samples_per_pixel"), 6);
}

TEST_F(Render, DefinitionsAndSettingsChangeTheScene) {
  run_well({"render", "path.xml", "-q", "--spp", "1", "-o", "a.exr", "-D", "size=10"});
  EXPECT_EQ(read_image(path("a.exr")).width(), 10);
  EXPECT_EQ(read_image(path("a.exr")).height(), 10);
  run_well({"render", "path.xml", "-q", "--spp", "1", "-o", "a.exr", "--set", "film.width=12"});
  EXPECT_EQ(read_image(path("a.exr")).width(), 12);
  EXPECT_EQ(read_image(path("a.exr")).height(), 24);
  run_well({"render", "path.xml", "-q", "--spp", "4", "-o", "a.exr"});
  run_well({"render", "path.xml", "-q", "--spp", "4", "-o", "b.exr", "--set", "metal.radius=0.1"});
  EXPECT_GT(mse("a.exr", "b.exr"), 0);
  run_well({"render", "path.xml", "-q", "--spp", "4", "-o", "b.exr", "--set",
            "integrator.components=direct"});
  EXPECT_LT(brightness("b.exr"), 0.9 * brightness("a.exr"));
}

TEST_F(Render, IntegratorReplacesTheFilesOwn) {
  run_well({"render", "path.xml", "-q", "--spp", "2", "-o", "a.exr"});
  run_well({"render", "photonmap.xml", "-q", "--spp", "2", "--integrator", "path", "-o", "b.exr"});
  EXPECT_EQ(mse("a.exr", "b.exr"), 0);
  run_well(
      {"render", "path.xml", "-q", "--spp", "2", "--integrator", "lighttracer", "-o", "c.exr"});
  EXPECT_GT(mse("a.exr", "c.exr"), 0);
}

TEST_F(Render, EveryFormatIsWritten) {
  std::vector<std::string> arguments = {"render", "path.xml", "-q", "--spp", "1"};
  const std::vector<std::string> formats = {"exr", "hdr", "pfm", "tif", "png", "jpg", "ppm"};
  for (const std::string& format : formats)
    arguments.insert(arguments.end(), {"-o", "a." + format});
  run_well(arguments);
  for (const std::string& format : formats) EXPECT_EQ(read_image(path("a." + format)).width(), 24);
}

TEST_F(Render, WithoutOutputTheSceneNamesTheFile) {
  run_well({"render", "path.xml", "-q", "--spp", "1"});
  EXPECT_TRUE(exists("path.exr"));
}

TEST_F(Render, MoreThreadsThanTheMachineHasAreNotUsed) {
  const RunResult result =
      run_well({"render", "path.xml", "-q", "--spp", "1", "--threads", "4096", "-o", "a.exr"});
  EXPECT_TRUE(contains(result.err, "--threads 4096: this process may run")) << result.err;
  EXPECT_FALSE(contains(result.err, "TBB")) << result.err;
}

TEST_F(Render, TimeLimitIsKept) {
  run_well({"render", "path.xml", "-q", "--time", "0.2s", "-o", "a.exr"});
  EXPECT_GT(brightness("a.exr"), 0);
}

TEST_F(Render, TimeThatIsTooShortForASampleWritesAFirstLook) {
  write("long.xml", small_scene("<integrator type=\"photonmap\"><integer name=\"global_photons\" "
                                "value=\"2000000000\"/></integrator>"));
  const RunResult result =
      run_well({"render", "long.xml", "--time", "0.1s", "-o", "a.exr", "-o", "a.png", "--denoise"});
  EXPECT_TRUE(contains(result.err,
                       "the time was over before every pixel had a sample: the picture "
                       "is a first look"))
      << result.err;
  EXPECT_GT(brightness("a.exr"), 0);
  EXPECT_TRUE(exists("a.png"));
  const Image image = read_image(path("a.exr"));
  EXPECT_TRUE(image.find_metadata("incomplete"));
  const MetadataValue* passes = image.find_metadata("passes");
  ASSERT_TRUE(passes);
  EXPECT_EQ(std::get<int64_t>(*passes), 0);
}

TEST_F(Render, ErrorLimitIsKept) {
  const auto passes = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> all = {"render", "path.xml", "-o", "a.exr"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const RunResult result = run_well(all);
    EXPECT_TRUE(contains(result.err, "error of the pixels: ")) << result.err;
    const Image image = read_image(path("a.exr"));
    const MetadataValue* count = image.find_metadata("passes");
    return count ? std::get<int64_t>(*count) : -1;
  };
  EXPECT_EQ(passes({"--error", "500%"}), 16);
  EXPECT_EQ(passes({"--error", "0.001%", "--passes", "20"}), 20);
  const int64_t in_time = passes({"--error", "0.001%", "--time", "2s"});
  EXPECT_GE(in_time, 1);
  for (const std::string wrong : {"2", "0%", "-1%", "two", "nan%"}) {
    const RunResult result = run({"render", "path.xml", "-o", "b.exr", "--error=" + wrong});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(contains(result.err, "cannot read the error")) << result.err;
  }
}

TEST_F(Render, ProgressTellsPercentPassesAndRays) {
  const RunResult shown = run_well({"render", "path.xml", "--spp", "2", "-o", "a.exr"});
  EXPECT_TRUE(contains(shown.err, "100 %")) << shown.err;
  EXPECT_TRUE(contains(shown.err, "rays/s")) << shown.err;
  EXPECT_TRUE(contains(shown.err, "wrote a.exr")) << shown.err;
  EXPECT_EQ(run_well({"render", "path.xml", "-q", "--spp", "2", "-o", "a.exr"}).err, "");
}

TEST_F(Render, ASceneWithoutLightIsBlackWithAWarning) {
  write("dark.xml", scene_with({"", true, true, false}));
  for (const std::string integrator : {"path", "lighttracer", "photonmap"}) {
    const RunResult result =
        run_well({"render", "dark.xml", "-q", "--integrator", integrator, "-o", "a.exr"});
    EXPECT_TRUE(contains(result.err, "no light")) << result.err;
    EXPECT_TRUE(contains(result.err, "add an emitter")) << result.err;
    EXPECT_EQ(brightness("a.exr"), 0);
  }
}

TEST_F(Render, AnEmptyCausticMapIsExplained) {
  // The mirror is there, but the lamp's light goes the other way.
  write("away.xml", scene_with({"<shape type=\"sphere\"><point name=\"center\" x=\"0\" y=\"0\" "
                                "z=\"5\"/><bsdf type=\"conductor\"/></shape>"
                                "<emitter type=\"spot\"><transform name=\"to_world\">"
                                "<lookat origin=\"0,0,2\" target=\"0,0,0\" up=\"0,1,0\"/>"
                                "</transform></emitter>",
                                true, true, false}));
  const RunResult result = run_well(
      {"render", "away.xml", "-q", "--integrator", "photonmap", "--spp", "1", "-o", "a.exr"});
  EXPECT_TRUE(contains(result.err, "the caustic map is empty")) << result.err;
}

TEST_F(Render, VcmWithoutTechniquesIsExplained) {
  write("vcm.xml", small_scene("<integrator type=\"vcm\"/>"));
  const auto warned = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"render", "vcm.xml", "-q", "--spp", "1", "-o", "a.exr"});
    for (const char* name : {"unidirectional", "next_event", "splats", "connections"})
      arguments.insert(arguments.end(), {"--set", "integrator." + std::string(name) + "=false"});
    return contains(run_well(arguments).err, "all techniques are switched off");
  };
  EXPECT_FALSE(warned({}));
  EXPECT_TRUE(warned({"--set", "integrator.merging=false"}));
}

TEST_F(Render, StoredPhotonsServeOtherViews) {
  const std::vector<std::string> photons = {"--set", "integrator.global_photons=20000", "--set",
                                            "integrator.caustic_photons=20000"};
  const auto with = [](std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  run_well(with({"photons", "photonmap.xml", "-o", "map.kpm"}, photons));
  run_well(with({"render", "photonmap.xml", "-q", "--spp", "32", "-o", "traced.exr"}, photons));
  const std::vector<std::string> stored = {"--set", "integrator.photon_map=map.kpm"};
  run_well(with({"render", "photonmap.xml", "-q", "--spp", "32", "-o", "stored.exr"}, stored));
  EXPECT_NEAR(brightness("stored.exr"), brightness("traced.exr"), 0.03 * brightness("traced.exr"));
  // The view may be another, the scene may not; nor what counts as specular.
  run_well(
      with({"render", "photonmap.xml", "-q", "-o", "b.exr", "--set", "sensor.fov=20"}, stored));
  const auto refused = [&](const std::vector<std::string>& change, const std::string& message) {
    const RunResult wrong =
        run(with(with({"render", "photonmap.xml", "-q", "-o", "c.exr"}, stored), change));
    EXPECT_EQ(wrong.exit_code, 2) << wrong.err;
    EXPECT_TRUE(contains(wrong.err, message)) << wrong.err;
    EXPECT_TRUE(contains(wrong.err, "remedy: ")) << wrong.err;
    EXPECT_FALSE(exists("c.exr"));
  };
  refused({"--set", "glass.radius=0.4"}, "another scene");
  refused({"--set", "integrator.specular_sampling=perfect"}, "another specular_sampling");
  // What passes a point in the air is in no map.
  std::string points = contents("photonmap.xml");
  const size_t at = points.find("perspective");
  points.replace(at, std::string("perspective").size(), "irradiancepoints");
  write("points.xml", points);
  const RunResult of_points =
      run(with({"render", "points.xml", "-q", "--spp", "1", "-o", "c.exr"}, stored));
  EXPECT_EQ(of_points.exit_code, 2) << of_points.err;
  EXPECT_TRUE(contains(of_points.err, "no light that passes points")) << of_points.err;
  write("map.kpm", contents("map.kpm").substr(0, 5000));
  refused({}, "map.kpm: the photon map is damaged");
  std::filesystem::remove(path("map.kpm"));
  refused({}, "cannot read 'map.kpm'");
}

}  // namespace
}  // namespace kaustik::test
