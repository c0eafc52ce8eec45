// The table of other renderers' integrators.

#include <fmt/format.h>

#include "kaustik/integrator/foreign_integrators.h"

namespace kaustik {
namespace {

using enum ParameterKind;
using Rows = std::vector<Parameter>;

Rows ignored(ParameterKind kind, const std::vector<std::string>& names) {
  Rows rows;
  for (const std::string& name : names) rows.push_back(ignored_parameter(name, kind));
  return rows;
}

Rows operator+(Rows a, const Rows& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Without rows that the native type has itself; other names of it are listed, but not its own.
ForeignIntegrator row(std::vector<std::string> names, std::string native, std::string sentence,
                      const Rows& rows) {
  const IntegratorType* type = find_integrator_type(native);
  ForeignIntegrator foreign{names, {"integrator", names[0], {}, {}}, std::move(native)};
  for (const Parameter& parameter : rows)
    if (!type || !type->info.find(parameter.name)) foreign.info.parameters.push_back(parameter);
  names.erase(names.begin());
  std::erase(names, foreign.native);
  if (!names.empty()) sentence += fmt::format(" Also: {}.", fmt::join(names, ", "));
  foreign.info.sentence = std::move(sentence);
  return foreign;
}

/// The method by another name, with the native type's parameters.
ForeignIntegrator same(std::vector<std::string> names, const std::string& native,
                       const Rows& rows) {
  const std::string sentence =
      names[0] == native
          ? fmt::format("Other renderers' '{0}': takes these parameters beside those of '{0}'.",
                        native)
          : fmt::format("Another renderer's name for '{0}'; takes the parameters of '{0}', too.",
                        native);
  return row(std::move(names), native, sentence, rows);
}

/// What is nearest to a method that is not here.
ForeignIntegrator nearest(std::vector<std::string> names, const std::string& native,
                          const Rows& rows) {
  ForeignIntegrator foreign = row(
      std::move(names), native,
      fmt::format("Not implemented: '{0}' renders the picture; takes the parameters of '{0}', too.",
                  native),
      rows);
  foreign.is_same = false;
  return foreign;
}

/// `theirs` stands for our parameter `ours`.
ForeignIntegrator with_name(ForeignIntegrator foreign, const std::string& theirs,
                            const std::string& ours) {
  foreign.renamed.emplace_back(theirs, ours);
  if (foreign.info.find(theirs)) {
    foreign.info.parameters.back().sentence += fmt::format(" And {}.", ours);
    return foreign;
  }
  Parameter parameter = *find_integrator_type(foreign.native)->info.find(ours);
  parameter.name = theirs;
  parameter.sentence = fmt::format("Here: {}.", ours);
  foreign.info.parameters.push_back(optional(std::move(parameter)));
  return foreign;
}

ForeignIntegrator with_implied(ForeignIntegrator foreign, const std::string& name, int64_t value) {
  foreign.info.sentence =
      fmt::format("'{}' with {} = {}. ", foreign.native, name, value) + foreign.info.sentence;
  foreign.implied.push_back({name, value, place_in("integrator " + foreign.names[0])});
  return foreign;
}

ForeignIntegrator holder(std::vector<std::string> names, const Rows& rows) {
  return row(std::move(names), "", "Ignored: the integrator inside it renders the picture.", rows);
}

ForeignIntegrator of_layers(ForeignIntegrator foreign) {
  foreign.is_of_layers = true;
  return foreign;
}

ForeignIntegrator refused(std::vector<std::string> names, const std::string& remedy) {
  ForeignIntegrator foreign =
      row(std::move(names), "",
          "Refused: it computes no radiance. Layers of the EXR hold these values.", {});
  foreign.refusal = remedy;
  return foreign;
}

/// Of Mitsuba's integrators that sample the camera.
Rows sampling_rows() {
  return ignored(boolean, {"hide_emitters", "strict_normals"}) +
         ignored(integer, {"samples_per_pass", "block_size"}) + ignored(number, {"timeout"});
}

/// Of Mitsuba's integrators that can be differentiated.
Rows differentiable_rows() {
  return ignored(integer, {"sppc", "sppp", "sppi", "guiding_rounds"}) + ignored(text, {"guiding"}) +
         ignored(boolean, {"guiding_proj", "use_spectral_mis", "use_nee"});
}

/// Of those of Mitsuba 0.6 that trace photons.
Rows photon_rows() {
  return ignored(integer, {"granularity", "max_passes", "photon_count", "photons_per_iteration",
                           "rr_depth", "max_depth"}) +
         ignored(number, {"alpha"}) +
         ignored(boolean, {"hide_emitters", "auto_cancel_gathering", "brute_force"});
}

Rows markov_rows() {
  return ignored(boolean, {"two_stage", "bidirectional", "bidirectional_mutation",
                           "lens_perturbation", "multi_chain_perturbation", "caustic_perturbation",
                           "manifold_perturbation", "hide_emitters"}) +
         ignored(integer, {"luminance_samples", "direct_samples", "timeout", "chain_length",
                           "max_chains", "shadow_map_resolution"}) +
         ignored(number, {"p_large", "lambda", "num_chains", "clamping"});
}

ForeignIntegrator photonmapper() {
  ForeignIntegrator foreign =
      same({"photonmapper"}, "photonmap",
           photon_rows() + ignored(number, {"global_lookup_radius", "caustic_lookup_radius"}) +
               ignored(integer, {"max_specular_depth"}));
  foreign = with_name(std::move(foreign), "lookup_size", "global_neighbors");
  foreign = with_name(std::move(foreign), "lookup_size", "caustic_neighbors");
  foreign = with_name(std::move(foreign), "direct_samples", "light_samples");
  return with_name(std::move(foreign), "glossy_samples", "specular_samples");
}

ForeignIntegrator bdpt() {
  ForeignIntegrator foreign = same({"bdpt", "BIDIRCPU"}, "bdpt", sampling_rows());
  foreign = with_name(std::move(foreign), "light_image", "splats");
  return with_name(std::move(foreign), "sample_direct", "next_event");
}

std::vector<ForeignIntegrator> all() {
  return {
      same({"volpath", "volpath_simple", "volpathmis", "volpathmip", "path", "prb", "prb_basic",
            "prb_projective", "prb_reparam", "prbvolpath", "simplepath", "simplevolpath",
            "randomwalk", "PATHCPU", "PATHOCL", "TILEPATHCPU", "TILEPATHOCL", "RTPATHCPU",
            "RTPATHOCL"},
           "path", sampling_rows() + differentiable_rows()),
      with_implied(same({"direct", "direct_projective", "direct_reparam"}, "path",
                        ignored(integer, {"shading_samples", "emitter_samples", "bsdf_samples"}) +
                            sampling_rows() + differentiable_rows()),
                   "max_depth", 2),
      same({"ptracer", "lightpath", "LIGHTCPU"}, "lighttracer", sampling_rows() + photon_rows()),
      bdpt(),
      photonmapper(),
      with_name(same({"sppm", "ppm"}, "ppm", photon_rows()), "initial_radius", "radius"),
      same({"BIDIRVMCPU"}, "vcm", sampling_rows()),
      nearest({"mlt", "pssmlt", "erpt", "vpl"}, default_integrator, markov_rows()),
      of_layers(holder({"aov", "moment", "stokes", "multichannel"}, ignored(text, {"aovs"}))),
      holder({"irrcache", "adaptive"},
             ignored(boolean, {"gradients", "clamp_neighbor", "clamp_screen", "overture",
                               "indirect_only", "debug"}) +
                 ignored(integer, {"resolution", "max_sample_factor"}) +
                 ignored(number, {"quality", "quality_adjustment", "max_error", "p_value"})),
      refused({"depth"},
              "the layer depth.Z of every EXR is the distance: render with another integrator, "
              "such as auto"),
      refused({"field", "motion"},
              "layers of every EXR hold depth, normals and albedo: render with another "
              "integrator, such as auto"),
  };
}

}  // namespace

const std::vector<ForeignIntegrator>& foreign_integrators() {
  static const std::vector<ForeignIntegrator> table = all();
  return table;
}

}  // namespace kaustik
