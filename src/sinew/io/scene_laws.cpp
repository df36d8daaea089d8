// Materials of solids: a law, its parameters, and what all laws share.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "sinew/io/scene_objects.hpp"
#include "sinew/io/scene_values.hpp"

namespace sinew::io {
namespace {

using enum Need;

/// All parameters that some law has.
struct Parameters {
  int law = 0;
  double young = 0.0, poisson = 0.0, c10 = 0.0, c01 = 0.0;
  std::optional<double> bulk;
  std::vector<double> mu, alpha;
  double viscosity = 0.0;
  std::optional<double> density;
};

/// A law of the scene file. A new one is a line here.
struct LawEntry {
  std::string name;
  std::vector<std::string> parameters;
  bool volume;  ///< also one of bulk and poisson
  solid::Law (*make)(const Parameters& p);
};

solid::Compressibility volume_of(const Parameters& p) {
  if (p.bulk) return solid::Bulk{*p.bulk};
  return solid::Poisson{p.poisson};
}

solid::Law ogden(const Parameters& p) {
  std::vector<solid::OgdenTerm> terms;
  for (std::size_t i = 0; i < p.mu.size(); ++i) terms.push_back({p.mu[i], p.alpha[i]});
  return solid::ogden(terms, volume_of(p));
}

const std::vector<LawEntry>& laws() {
  using P = const Parameters&;
  static const std::vector<LawEntry> all = {
      {"corotational",
       {"young", "poisson"},
       false,
       [](P p) -> solid::Law { return solid::corotational(p.young, p.poisson); }},
      {"saint_venant_kirchhoff",
       {"young", "poisson"},
       false,
       [](P p) -> solid::Law { return solid::saint_venant_kirchhoff(p.young, p.poisson); }},
      {"neo_hookean",
       {"young", "poisson"},
       false,
       [](P p) -> solid::Law { return solid::neo_hookean(p.young, p.poisson); }},
      {"mooney_rivlin",
       {"c10", "c01"},
       true,
       [](P p) -> solid::Law { return solid::mooney_rivlin(p.c10, p.c01, volume_of(p)); }},
      {"ogden", {"mu", "alpha"}, true, ogden}};
  return all;
}

std::vector<std::string> law_names() {
  std::vector<std::string> names;
  for (const LawEntry& law : laws()) names.push_back(law.name);
  return names;
}

const std::vector<std::string> of_volume = {"bulk", "poisson"};

/// The parameters of the law that is named, and no others.
Rule of_their_law() {
  const auto check = [](const At& at, const std::vector<Key>& keys) {
    const LawEntry* law = at.has("law") ? nullptr : &laws()[0];
    for (const LawEntry& one : laws()) {
      if (at.says("law", one.name)) law = &one;
    }
    if (!law) return;  // no law: its own key says so
    const auto has = [&](const std::string& name) {
      return std::find(law->parameters.begin(), law->parameters.end(), name) != law->parameters.end() ||
             (law->volume && std::find(of_volume.begin(), of_volume.end(), name) != of_volume.end());
    };
    for (const Key& key : keys) {
      const bool common = key.name == "law" || key.name == "viscosity" || key.name == "density";
      if (at.has(key.name) && !common && !has(key.name)) {
        at.refuse_key(key.name, fmt::format("is not a parameter of {}", law->name),
                      fmt::format("its parameters are {}{}", fmt::join(law->parameters, ", "),
                                  law->volume ? ", and bulk or poisson" : ""));
      }
      const bool wanted = std::find(law->parameters.begin(), law->parameters.end(), key.name) != law->parameters.end();
      if (wanted && !at.has(key.name)) at.refuse_key(key.name, "is missing", "add it: " + help(key));
    }
    if (law->volume && at.has("bulk") == at.has("poisson")) {
      at.refuse_key(
          "bulk",
          at.has("bulk") ? "cannot be given together with poisson" : "is missing: one of bulk, poisson is needed",
          "give one of bulk [Pa] and poisson");
    }
  };
  Json schema;
  for (const LawEntry& law : laws()) {
    Json then = {{"required", law.parameters}};
    if (law.volume) then["oneOf"] = Json::array({{{"required", {"bulk"}}}, {{"required", {"poisson"}}}});
    Json when = says_schema("law", law.name);
    if (&law == &laws()[0]) when = {{"anyOf", {{{"not", {{"required", {"law"}}}}}, when}}};
    schema["allOf"].push_back({{"if", when}, {"then", then}});
  }
  return {check, schema};
}

}  // namespace

Type<SolidMaterial> solid_material() {
  using P = Parameters;
  const Range poisson = {-1.0, 0.5, true, true, " in a solid", "use 0.49 for a nearly incompressible silicone"};
  const Type<double> modulus = quantity(Dimension::pressure, above(0.0));
  const Type<std::vector<double>> moduli =
      list<double>("moduli, one for each of `alpha`", quantity(Dimension::pressure), {1, solid::Ogden::kMostTerms});
  const Type<std::vector<double>> powers =
      list<double>("powers, none of them 0", quantity(Dimension::number), {1, solid::Ogden::kMostTerms});
  const auto check = [](const Parameters& p, const At& at) {
    if (p.mu.size() != p.alpha.size())
      at.child("alpha").refuse(fmt::format("must be as many as mu, {}, not {}", p.mu.size(), p.alpha.size()),
                               "give a power for each modulus");
    if (std::find(p.alpha.begin(), p.alpha.end(), 0.0) != p.alpha.end())
      at.child("alpha").refuse("must not contain 0", "leave that term out");
  };
  const Type<Parameters> type = map<P>(
      {"a solid's material",
       {field<P>({"law", optional, "the constitutive law", "corotational"}, &P::law, word(law_names())),
        field<P>({"young", optional, "Young's modulus [Pa]", "600 kPa"}, &P::young, modulus),
        field<P>({"poisson", optional, "Poisson's ratio", "0.45"}, &P::poisson, quantity(Dimension::number, poisson)),
        field<P>({"c10", optional, "its first constant [Pa]", "80 kPa"}, &P::c10, quantity(Dimension::pressure)),
        field<P>({"c01", optional, "its second constant [Pa]", "20 kPa"}, &P::c01, quantity(Dimension::pressure)),
        field<P>({"mu", optional, "its moduli [Pa]", "[630 kPa, 1.2 kPa, -10 kPa]"}, &P::mu, moduli),
        field<P>({"alpha", optional, "its powers", "[1.3, 5, -2]"}, &P::alpha, powers),
        field<P>({"bulk", optional, "the bulk modulus [Pa]", "50 MPa"}, &P::bulk, modulus),
        field<P>({"viscosity", optional, "its viscosity against shear [Pa s]; 4/3 (1 + nu)^2 of it against extension",
                  "300 Pa s"},
                 &P::viscosity, quantity(Dimension::viscosity, at_least(0.0))),
        field<P>({"density", optional, "its density [kg/m^3], instead of the solid's", "1100 kg/m^3"}, &P::density,
                 quantity(Dimension::density, above(0.0)))},
       {of_their_law()},
       check});
  return {[=](const At& at) {
            const Parameters p = type.read(at);
            return SolidMaterial{laws()[static_cast<std::size_t>(p.law)].make(p), p.viscosity, p.density};
          },
          type.schema};
}

}  // namespace sinew::io
