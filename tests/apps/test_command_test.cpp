// kaustik test: statistical tests of Nori's files.

#include "tests/apps/program.h"

namespace kaustik::test {
namespace {

/// A box around the camera whose faces look inward.
const std::string box_obj =
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
    "f 1 2 3 4\nf 8 7 6 5\nf 1 4 8 5\nf 6 7 3 2\nf 4 3 7 8\nf 5 6 2 1\n";

/// A furnace: its walls shine 1 and reflect half, so the camera sees 2, by direct light alone 1.5.
std::string furnace(const std::string& integrator) {
  return "<scene><integrator type=\"" + integrator +
         "\"/><camera type=\"perspective\"><integer name=\"width\" value=\"1\"/>"
         "<integer name=\"height\" value=\"1\"/></camera><mesh type=\"obj\">"
         "<string name=\"filename\" value=\"box.obj\"/><bsdf type=\"diffuse\"/>"
         "<emitter type=\"area\"><color name=\"radiance\" value=\"1 1 1\"/></emitter></mesh>"
         "</scene>\n";
}

std::string means(const std::string& references, const std::string& inside) {
  return "<test type=\"ttest\"><string name=\"references\" value=\"" + references +
         "\"/><integer name=\"sampleCount\" value=\"20000\"/>\n" + inside + "</test>\n";
}

class TestCommand : public ProgramTest {
 protected:
  TestCommand() { write("box.obj", box_obj); }
};

TEST_F(TestCommand, PassesWhatIsTrue) {
  write("furnace.xml",
        means("2, 1.5, 1.5", furnace("path_mis") + furnace("direct_ems") + furnace("whitted")));
  const RunResult result = run_well({"test", "furnace.xml"});
  EXPECT_TRUE(contains(result.out, "passed: scene on line 2: mean ")) << result.out;
  EXPECT_TRUE(contains(result.out, "expected 1.5")) << result.out;
  EXPECT_TRUE(result.out.ends_with("3 of 3 tests passed\n")) << result.out;
}

TEST_F(TestCommand, FailsWhatIsFalse) {
  write("furnace.xml", means("2, 1.52", furnace("path_mis") + furnace("direct_ems")));
  const RunResult result = run({"test", "furnace.xml"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result.out, "failed: scene on line 3: mean 1.")) << result.out;
  EXPECT_TRUE(result.out.ends_with("1 of 2 tests passed\n")) << result.out;
  EXPECT_EQ(result.err, "");
}

TEST_F(TestCommand, ChecksBsdfs) {
  write("angles.xml",
        "<test type=\"ttest\"><string name=\"angles\" value=\"0 80\"/><string name=\"references\" "
        "value=\"0.25 0.25\"/><bsdf type=\"diffuse\"><color name=\"albedo\" value=\".25 .25 .25\"/>"
        "</bsdf></test>");
  EXPECT_TRUE(run_well({"test", "angles.xml"}).out.ends_with("2 of 2 tests passed\n"));
  write("density.xml",
        "<test type=\"chi2test\"><integer name=\"sampleCount\" value=\"100000\"/>"
        "<bsdf type=\"microfacet\"><float name=\"alpha\" value=\"0.3\"/></bsdf></test>");
  const std::string out = run_well({"test", "density.xml"}).out;
  EXPECT_TRUE(contains(out, "direction 5: 100000 samples, p = ")) << out;
  EXPECT_TRUE(out.ends_with("5 of 5 tests passed\n")) << out;
}

TEST_F(TestCommand, TellsWhatItCannotRun) {
  write("av.xml", means("1, 2", furnace("av") + furnace("path")));
  const RunResult result = run_well({"test", "av.xml"});
  EXPECT_TRUE(contains(result.out, "not run: scene on line 2: all directions")) << result.out;
  EXPECT_TRUE(result.out.ends_with("1 of 1 tests passed, 1 not run\n")) << result.out;
}

TEST_F(TestCommand, RefusesWhatHasNoTests) {
  write("scene.xml", furnace("path"));
  const RunResult result = run({"test", "scene.xml"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.err, "holds no tests")) << result.err;
  write("test.xml", means("2", furnace("path")));
  const RunResult rendered = run({"render", "test.xml", "-o", "a.exr"});
  EXPECT_EQ(rendered.exit_code, 2);
  EXPECT_TRUE(contains(rendered.err, "kaustik test FILE")) << rendered.err;
}

}  // namespace
}  // namespace kaustik::test
