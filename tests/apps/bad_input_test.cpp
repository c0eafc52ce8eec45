// Whatever is wrong with what the user gives: the message with its place and remedy, the exit code,
// and that no file is harmed or left behind.

#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

class BadInput : public ProgramTest {
 protected:
  /// Expects that rendering scene.xml is refused: the message starts with `place` and holds
  /// `message`, the remedy holds `remedy`; an old output survives, a new one does not appear.
  void expect_refused(const std::string& place, const std::string& message,
                      const std::string& remedy) const {
    write("old.exr", "precious");
    const auto before = files();
    const RunResult result = run({"render", "scene.xml", "-o", "old.exr", "-o", "new.png"});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(contains(result.err, place + ":")) << result.err << "\nexpected at " << place;
    EXPECT_TRUE(contains(result.err, message)) << result.err << "\nexpected: " << message;
    const size_t at = result.err.find("remedy: ");
    ASSERT_NE(at, std::string::npos) << result.err;
    EXPECT_TRUE(contains(result.err.substr(at), remedy)) << result.err << "\nexpected: " << remedy;
    EXPECT_EQ(files(), before);
    EXPECT_EQ(contents("old.exr"), "precious");
  }
  /// The same for a scene with `inside` on its second line.
  void expect_refused_inside(const std::string& inside, const std::string& place,
                             const std::string& message, const std::string& remedy) const {
    SCOPED_TRACE(inside);
    write("scene.xml", scene_with({inside}));
    expect_refused(place, message, remedy);
  }
  /// A mesh that is named on line 2.
  void expect_mesh_refused(const std::string& name, const std::string& bytes,
                           const std::string& place, const std::string& message,
                           const std::string& remedy) const {
    SCOPED_TRACE(bytes);
    write(name, bytes);
    const std::string type = name.substr(name.find('.') + 1);
    expect_refused_inside(
        "<shape type=\"" + type + "\"><string name=\"filename\" value=\"" + name + "\"/></shape>",
        place, message, remedy);
  }
};

TEST_F(BadInput, MissingSceneFile) {
  expect_refused("scene.xml", "No such file", "check the name");
  const RunResult folder = run({"render", ".", "-o", "new.png"});
  EXPECT_EQ(folder.exit_code, 2) << folder.err;
  EXPECT_TRUE(contains(folder.err, "it is a folder")) << folder.err;
}

TEST_F(BadInput, BrokenXml) {
  write("scene.xml", "<scene version=\"3.0.0\">\n  <shape type=\"sphere\">\n</scene>\n");
  expect_refused("scene.xml:3:3", "mismatch", "<shape>");
  write("scene.xml", "<scene version=\"3.0.0\">\n  <shape type=\"sph");
  expect_refused("scene.xml:2:16", "attribute", "correct the XML");
  write("scene.xml", "");
  expect_refused("scene.xml:1", "no XML element", "a scene starts with");
  write("scene.xml", std::string("\x7f"
                                 "ELF\0\0\0\1\2",
                                 10));
  expect_refused("scene.xml:1", "not XML text", "give a Mitsuba XML scene");
}

TEST_F(BadInput, UnknownTypesGetTheNearestName) {
  expect_refused_inside("<shape type=\"spere\"/>", "scene.xml:2:1", "unknown shape type 'spere'",
                        "did you mean 'sphere'?");
  expect_refused_inside("<bsdf type=\"difuse\"/>", "scene.xml:2:1", "unknown bsdf type 'difuse'",
                        "did you mean 'diffuse'?");
  expect_refused_inside("<emitter type=\"pont\"/>", "scene.xml:2:1", "unknown emitter type 'pont'",
                        "did you mean 'point'?");
  expect_refused_inside("<integrator type=\"photon_map\"/>", "scene.xml:2:1",
                        "unknown integrator type 'photon_map'", "did you mean 'photonmap'?");
  expect_refused_inside("<shap type=\"sphere\"/>", "scene.xml:2:1", "unknown element <shap>",
                        "did you mean 'shape'?");
  expect_refused_inside(
      "<bsdf type=\"diffuse\"><texture type=\"bitmp\" name=\"reflectance\"/></bsdf>",
      "scene.xml:2:22", "unknown texture type 'bitmp'", "did you mean 'bitmap'?");
}

// Left out and told, or with --strict refused.
TEST_F(BadInput, UnknownPropertiesGetTheNearestName) {
  const std::string shape = R"(<shape type="sphere"><float name="radus" value="1"/></shape>)",
                    integrator = R"(<integrator type="path"><integer name="rr_deph" value="1"/>)"
                                 "</integrator>";
  write("scene.xml", scene_with({shape + "\n" + integrator}));
  const RunResult told = run({"render", "scene.xml", "--spp", "1", "-o", "a.exr"});
  EXPECT_EQ(told.exit_code, 0) << told.err;
  EXPECT_TRUE(contains(told.err,
                       "scene.xml:2:22: shape 'sphere' has no parameter 'radus': it is "
                       "left out; did you mean 'radius'?"))
      << told.err;
  EXPECT_TRUE(contains(told.err,
                       "scene.xml:3:25: integrator 'path' has no parameter 'rr_deph': it "
                       "is left out; did you mean 'rr_depth'?"))
      << told.err;
  const RunResult refused = run({"render", "scene.xml", "--strict", "-o", "b.exr"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(contains(refused.err, "did you mean 'radius'?")) << refused.err;
  const RunResult typed =
      run({"render", "scene.xml", "--set", "integrator.rr_deph=2", "-o", "b.exr"});
  EXPECT_EQ(typed.exit_code, 2);
  EXPECT_TRUE(contains(typed.err, "has no parameter 'rr_deph'")) << typed.err;
}

TEST_F(BadInput, WrongTypesAndRanges) {
  expect_refused_inside("<shape type=\"sphere\"><string name=\"radius\" value=\"big\"/></shape>",
                        "scene.xml:2:22", "'radius' has the wrong type", "float");
  expect_refused_inside("<shape type=\"sphere\"><float name=\"radius\" value=\"big\"/></shape>",
                        "scene.xml:2:50", "'big' is not a number", "");
  expect_refused_inside("<shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/></shape>",
                        "scene.xml:2:22", "'radius' is -1, outside its range", "give a value from");
  expect_refused_inside("<shape type=\"sphere\"><float name=\"radius\" value=\"nan\"/></shape>",
                        "scene.xml:2:50", "not a finite number", "");
  expect_refused_inside(
      "<integrator type=\"photonmap\"><integer name=\"caustic_photons\" "
      "value=\"-3\"/></integrator>",
      "scene.xml:2:30", "outside its range", "from 0");
  expect_refused_inside(
      "<integrator type=\"path\"><string name=\"components\" "
      "value=\"direct,causic\"/></integrator>",
      "scene.xml:2:25", "'causic'", "did you mean 'caustic'?");
}

TEST_F(BadInput, References) {
  expect_refused_inside(
      "<bsdf type=\"diffuse\" id=\"white\"/><shape type=\"sphere\"><ref id=\"whit\"/></shape>",
      "scene.xml:2:55", "'whit'", "did you mean 'white'?");
  expect_refused_inside("<bsdf type=\"diffuse\" id=\"a\"/>\n<bsdf type=\"diffuse\" id=\"a\"/>",
                        "scene.xml:3:1", "the id 'a' is taken", "the first is at scene.xml:2:1");
  expect_refused_inside("<shape type=\"sphere\"><float name=\"radius\" value=\"$size\"/></shape>",
                        "scene.xml:2:50", "$size is not defined", "-D size=");
}

TEST_F(BadInput, Includes) {
  expect_refused_inside("<include filename=\"none.xml\"/>", "scene.xml:2:20", "No such file", "");
  write("other.xml", "<scene version=\"3.0.0\">\n <include filename=\"scene.xml\"/></scene>");
  expect_refused_inside("<include filename=\"other.xml\"/>", "other.xml:2:21",
                        "circular <include>: scene.xml → other.xml → scene.xml", "remove one");
  write("other.xml", "<scene version=\"3.0.0\">\n\n  <shape type=\"spere\"/></scene>");
  expect_refused_inside("<include filename=\"other.xml\"/>", "other.xml:3:3",
                        "unknown shape type 'spere'", "did you mean 'sphere'?");
}

TEST_F(BadInput, MissingAndUnreadableMeshes) {
  expect_refused_inside("<shape type=\"obj\"><string name=\"filename\" value=\".\"/></shape>",
                        "scene.xml:2:19", "not a regular file", "give the name of a file");
  expect_refused_inside("<shape type=\"ply\"/>", "scene.xml:2:1", "shape 'ply' needs 'filename'",
                        "Mesh file");
  expect_mesh_refused("a.ply", "solid\n", "a.ply:1", "PLY", "");
  expect_mesh_refused("b.obj", std::string(100, '\1'), "b.obj", "OBJ", "");
  expect_mesh_refused("empty.ply", "", "empty.ply:1", "does not start with", "give a PLY file");
  expect_mesh_refused("empty.obj", "", "empty.obj", "no faces", "");
}

constexpr const char* ply_header =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST_F(BadInput, DamagedMeshes) {
  const std::string header = ply_header;
  expect_mesh_refused("cut.ply", header + "0 0 0\n1 0 0\n", "cut.ply:10",
                      "more than the file can hold", "truncated");
  expect_mesh_refused("nan.ply", header + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "nan.ply:11",
                      "finite", "");
  expect_mesh_refused("inf.ply", header + "0 0 0\n1 0 0\n0 inf 0\n3 0 1 2\n", "inf.ply:12",
                      "finite", "");
  expect_mesh_refused("far.ply", header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "far.ply:13", "3", "");
  expect_mesh_refused("nan.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n", "nan.obj:2", "", "");
  expect_mesh_refused("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "far.obj:4", "4", "");
  expect_mesh_refused("cut.obj", "v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n", "cut.obj:3", "", "");
  expect_mesh_refused("huge.ply",
                      "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\n"
                      "property float x\nproperty float y\nproperty float z\n"
                      "element face 1\nproperty list uchar int vertex_indices\nend_header\nabc",
                      "huge.ply", "", "");
}

TEST_F(BadInput, MessagesInMeshesSayWhoNamedThem) {
  write("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
  write(
      "scene.xml",
      scene_with({"<shape type=\"obj\">\n <string name=\"filename\" value=\"far.obj\"/></shape>"}));
  expect_refused("far.obj:4", "(named in scene.xml:3:2)", "");
}

TEST_F(BadInput, EmptyScenesAndMissingCameras) {
  write("scene.xml", "<scene version=\"3.0.0\"/>");
  expect_refused("scene.xml:1:1", "the scene has no camera", "add a sensor");
  write("scene.xml", scene_with({R"(<sensor type="perspective" id="side"/>)", true, true, true}));
  const RunResult result = run({"render", "scene.xml", "--camera", "sied", "-o", "a.exr"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.err, "the scene has no camera 'sied'")) << result.err;
  EXPECT_TRUE(contains(result.err, "did you mean 'side'?")) << result.err;
}

/// A scene whose film has this size.
std::string film_of(const std::string& width, const std::string& height) {
  return scene_with(
      {"<sensor type=\"perspective\"><film type=\"hdrfilm\">"
       "<integer name=\"width\" value=\"" +
           width + "\"/>\n<integer name=\"height\" value=\"" + height + "\"/></film></sensor>",
       false, true, true});
}

TEST_F(BadInput, FilmsTooSmallAndTooLarge) {
  write("scene.xml", film_of("0", "16"));
  expect_refused("scene.xml:2:49", "'width' is 0, outside its range", "from 1");
  write("scene.xml", film_of("16", "-1"));
  expect_refused("scene.xml:3:1", "'height' is -1, outside its range", "from 1");
  write("scene.xml", film_of("50000", "20000"));
  expect_refused("scene.xml:2:28", "50000", "smaller");
  write("scene.xml", film_of("1000000000", "1"));
  expect_refused("scene.xml:2:49", "'width' is 1000000000, outside its range", "");
}

TEST_F(BadInput, SeveralProblemsAreToldAtOnce) {
  write("scene.xml",
        scene_with({"<shape type=\"spere\"/>\n<bsdf type=\"difuse\"/>\n"
                    "<shape type=\"sphere\"><float name=\"radus\" value=\"1\"/></shape>"}));
  expect_refused("scene.xml:2:1", "unknown shape type", "sphere");
  const RunResult result = run({"info", "scene.xml", "--strict"});
  EXPECT_EQ(result.exit_code, 2);
  for (const char* place : {"scene.xml:2:1: ", "scene.xml:3:1: ", "scene.xml:4:22: "})
    EXPECT_TRUE(contains(result.err, place)) << result.err;
}

TEST_F(BadInput, ExcerptsPointAtTheProblem) {
  write("scene.xml", scene_with({"  <shape type=\"spere\"/>"}));
  const RunResult result = run({"render", "scene.xml", "-o", "new.png"});
  EXPECT_TRUE(contains(result.err, "      <shape type=\"spere\"/>\n      ^")) << result.err;
}

TEST_F(BadInput, SettingsFromTheCommandLine) {
  write("scene.xml", scene_with({}));
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& message,
                           const std::string& remedy) {
    std::vector<std::string> all = {"render", "scene.xml", "-o", "new.png"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const RunResult result = run(all);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(contains(result.err, message)) << result.err << "\nexpected: " << message;
    EXPECT_TRUE(contains(result.err, remedy)) << result.err << "\nexpected: " << remedy;
    EXPECT_FALSE(exists("new.png"));
  };
  refused({"--integrator", "photonmpa"},
          "command line: --integrator: unknown integrator type 'photonmpa'",
          "did you mean 'photonmap'?");
  refused({"--integrator", "photonmap", "--set", "integrator.caustic_neighbor=3"},
          "no parameter 'caustic_neighbor'", "did you mean 'caustic_neighbors'?");
  refused({"--integrator", "photonmap", "--set", "integrator.caustic_neighbors=-3"},
          "outside its range", "--set");
  refused({"--integrator", "photonmap", "--set", "integrator.caustic_neighbors=many"},
          "has the wrong type", "integer");
  refused({"--set", "nonsense"}, "command line: --set nonsense: cannot read the setting 'nonsense'",
          "object.parameter=value");
  refused({"--set", "fil.width=3"}, "no object 'fil'", "did you mean 'film'?");
  refused({"-D", "size"}, "command line: -D: cannot read the definition 'size'", "-D name=value");
  refused({"--time", "soon"}, "command line: --time: cannot read the time 'soon'", "60s");
  refused({"--time", "-5s"}, "cannot read the time '-5s'", "60s");
  // What an unset variable of a script leaves.
  refused({"--time", ""}, "cannot read the time ''", "60s");
  refused({"--error", ""}, "cannot read the error ''", "2%");
  refused({"--checkpoint", ""}, "the name of the output file is empty", "give a file name");
  refused({"--error", "abc"}, "command line: --error: cannot read the error 'abc'", "2%");
  refused({"--checkpoint", "a.kpt", "--every", "often"},
          "command line: --every: cannot read the time 'often'", "60s");
  refused({"--every", "5s"}, "--every requires --checkpoint", "");
  refused({"--tonemap", "histogramm"}, "histogramm", "histogram");
  refused({"--spp", "0"}, "--spp", "");
  refused({"--threads", "-1"}, "--threads", "");
  refused({"--colour"}, "--colour", "");
}

TEST_F(BadInput, CommandsAndImages) {
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& message) {
    SCOPED_TRACE(arguments.empty() ? "" : arguments[0]);
    const RunResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_TRUE(contains(result.err, message)) << result.err << "\nexpected: " << message;
  };
  write("text.exr", "this is no image");
  write("cut.pfm", "PF\n100 100\n-1.0\nabc");
  refused({}, "kaustik example");
  refused({"rendre"}, "did you mean 'render'?");
  refused({"render"}, "scene is required");
  refused({"help", "photonmpa"}, "did you mean 'photonmap'?");
  refused({"tonemap", "none.exr", "-o", "new.png"}, "none.exr");
  refused({"tonemap", "text.exr", "-o", "new.png"}, "text.exr");
  refused({"tonemap", "cut.pfm", "-o", "new.png"}, "cut.pfm");
  refused({"tonemap", "cut.pfm", "-o", "new.xyz"}, "new.xyz");
  refused({"compare", "none.exr", "text.exr"}, "none.exr");
  refused({"denoise", "none.exr", "-o", "new.exr"}, "none.exr");
  refused({"denoise", "cut.pfm", "-o", "new.exr"}, "cut.pfm");
  refused({"info", "none.xml"}, "none.xml");
  refused({"photons", "none.xml", "-o", "new.kpm"}, "none.xml");
  refused({"photons", "none.xml"}, "--output");
  EXPECT_EQ(files(), (std::vector<std::string>{"cut.pfm", "text.exr"}));
}

TEST_F(BadInput, Textures) {
  const auto refuse = [&](const std::string& name, const std::string& bytes,
                          const std::string& message, const std::string& remedy) {
    write(name, bytes);
    expect_refused_inside(
        "<shape type=\"sphere\"><bsdf type=\"diffuse\"><texture name=\"reflectance\" "
        "type=\"bitmap\"><string name=\"filename\" value=\"" +
            name + "\"/></texture></bsdf></shape>",
        "scene.xml:2", message, remedy);
  };
  refuse("text.png", "hello", "no image of a known format", "complete");
  refuse("short.ppm", "P6\n4 4\n255\nabc", "short.ppm", "complete");
  refuse("none.ppm", "P6\n0 0\n255\n", "none.ppm", "complete");
  refuse("wide.ppm", "P6\n100000 100000\n255\n", "wide.ppm", "complete");
}

TEST_F(BadInput, BumpMapsAndMixtures) {
  const auto refuse = [&](const std::string& bsdf, const std::string& message,
                          const std::string& remedy) {
    expect_refused_inside("<shape type=\"sphere\">" + bsdf + "</shape>", "scene.xml:2", message,
                          remedy);
  };
  const std::string diffuse = "<bsdf type=\"diffuse\"/>";
  refuse("<bsdf type=\"bumpmap\">" + diffuse + "</bsdf>", "'bumpmap' has no texture",
         "put a texture into it");
  refuse("<bsdf type=\"bumpmap\"><texture type=\"noise\"/></bsdf>", "holds 0 bsdfs", "1");
  const std::string bumped =
      "<bsdf type=\"bumpmap\"><texture type=\"noise\"/>" + diffuse + "</bsdf>";
  refuse("<bsdf type=\"blendbsdf\">" + bumped + diffuse + "</bsdf>", "bump or normal map",
         "around the 'blendbsdf'");
  refuse("<bsdf type=\"twosided\"><bsdf type=\"mask\">" + diffuse + "</bsdf></bsdf>",
         "transmits light", "without 'twosided'");
  refuse("<bsdf type=\"thinphong\"><rgb name=\"diffuse_transmittance\" value=\"0.8\"/></bsdf>",
         "add up to 1.2", "at most 1");
}

}  // namespace
}  // namespace kaustik::test
