// SPDX-License-Identifier: GPL-3.0-or-later
// Makes kernels/src/bsdf/ggx_albedo.inc: the directional albedos of GGX lobes, by quadrature over visible normals.
//
//   g++ -O3 -march=native -std=c++20 -Ikernels/src tools/make_tables/ggx_albedo.cpp -o /tmp/ggx_albedo
//   /tmp/ggx_albedo > kernels/src/bsdf/ggx_albedo.inc        (about a minute)
//
// Layout and parameters follow Cycles (src/app/cycles_precompute.cpp of its repository), so that interpolation between
// nodes errs alike: roughness varies fastest (alpha = roughness^2), then cos theta, then z with
// index = index_from_f0(z^4). Nodes at 0 are taken at 1e-4, z at most 0.99.
#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"

#include <cstdint>
#include <cstdio>
#include <vector>

using namespace opal;

namespace {

// Points of the R2 sequence (Roberts 2018), centred.
Vec2 quadrature_point(uint32_t i) {
  const uint64_t x = uint64_t(i) * 3242174889u + 0x80000000u, y = uint64_t(i) * 2447445414u + 0x80000000u;
  return {float(uint32_t(x) >> 8) * 0x1p-24f, float(uint32_t(y) >> 8) * 0x1p-24f};
}

struct Node {
  Ggx ggx;
  Vec3 wo;
  Node(float roughness, float mu) : ggx{sqr(roughness), sqr(roughness)}, wo{std::sqrt(1 - sqr(mu)), 0, mu} {}
};

// Share of what a perfect mirror's facets send up without a second bounce.
float reflected(const Node &n, const Vec3 &m) {
  const Vec3 wi = reflect(n.wo, m);
  if (wi.z <= 0) return 0;
  const float lambda_o = n.ggx.lambda(n.wo);
  return (1 + lambda_o) / (1 + lambda_o + n.ggx.lambda(wi));
}
// `any_side` counts light that is refracted out of the wrong side too. No lobe lets it through, but Cycles' table for the
// dense side was made so, and rough Glass nodes shall look alike; gems use the other.
float glass(const Node &n, const Vec3 &m, float eta, bool any_side) {
  if (std::abs(eta - 1) < 1e-4f) return 1;  // taken as no boundary (microfacet.h)
  const float cos_o = dot(n.wo, m);
  float cos_t;
  const float f = fresnel_dielectric(cos_o, eta, cos_t);
  float sum = f * reflected(n, m);
  const Vec3 wi = refract(n.wo, m, eta, cos_t);
  if (f < 1 && (any_side || wi.z < 0)) {
    const float lambda_o = n.ggx.lambda(n.wo);
    sum += (1 - f) * (1 + lambda_o) / (1 + lambda_o + n.ggx.lambda(wi));
  }
  return sum;
}
// Where between f0 and f90 the reflectance lies; 0 for facets that reflect into the surface.
float schlick_position(const Node &n, const Vec3 &m, float s) { return reflect(n.wo, m).z > 0 ? saturate(s) : 0.0f; }

template <typename F>
float average_over_facets(float roughness, float mu, uint32_t samples, F value) {
  const Node node(roughness, mu);
  double sum = 0;
  for (uint32_t i = 0; i < samples; ++i) sum += double(value(node, node.ggx.sample_visible(node.wo, quadrature_point(i))));
  return float(sum / samples);
}
// 2 times the integral of mu E(mu) by Gauss-like midpoints in mu^2.
template <typename F>
float average_over_cosines(float roughness, uint32_t samples, F value) {
  constexpr int kSteps = 256;
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) sum += double(average_over_facets(roughness, std::sqrt((float(k) + 0.5f) / kSteps), samples, value));
  return float(sum / kSteps);
}

float node_value(int i, int n, float high = 1) { return clamp(float(i) / float(n - 1), 1e-4f, high); }

void print(const char *name, const std::vector<float> &values, const char *what) {
  std::printf("// %s\ninline constexpr float %s[%zu] = {", what, name, values.size());
  for (size_t i = 0; i < values.size(); ++i) std::printf("%s%.5ff", i == 0 ? "\n" : i % 16 == 0 ? ",\n" : ",", double(values[i]));
  std::printf("};\n\n");
}

}  // namespace

int main() {
  std::printf("// SPDX-License-Identifier: GPL-3.0-or-later\n// Made by tools/make_tables/ggx_albedo.cpp: do not edit.\n\n");
  constexpr uint32_t kSamples = 1u << 15;
  std::vector<float> table;

  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) table.push_back(average_over_facets(node_value(x, 32), node_value(y, 32), 4 * kSamples, reflected));
  print("kGgxE", table, "Reflection without Fresnel, [cos][roughness]");
  table.clear();
  for (int x = 0; x < 32; ++x) table.push_back(average_over_cosines(node_value(x, 32), kSamples, reflected));
  print("kGgxEavg", table, "The same averaged over 2 cos d(cos), [roughness]");

  for (const bool inside : {false, true}) {
    std::vector<float> e, average;
    for (int z = 0; z < 16; ++z) {
      const float index = index_from_f0(sqr(sqr(node_value(z, 16, 0.99f))));
      const float eta = inside ? 1 / index : index;
      const auto value = [eta, inside](const Node &n, const Vec3 &m) { return glass(n, m, eta, inside); };
      for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) e.push_back(average_over_facets(node_value(x, 16), node_value(y, 16), kSamples, value));
      for (int x = 0; x < 16; ++x) average.push_back(average_over_cosines(node_value(x, 16), kSamples / 8, value));
    }
    print(inside ? "kGgxGlassInsideE" : "kGgxGlassE", e,
          inside ? "Reflection and transmission of a dielectric from the dense side, [z][cos][roughness]"
                 : "Reflection and transmission of a dielectric from the thin side, [z][cos][roughness]");
    print(inside ? "kGgxGlassInsideEavg" : "kGgxGlassEavg", average, "The same averaged over 2 cos d(cos), [z][roughness]");
  }

  table.clear();
  for (int z = 0; z < 16; ++z) {
    const float eta = 1 / index_from_f0(sqr(sqr(node_value(z, 16, 0.99f))));
    const auto value = [eta](const Node &n, const Vec3 &m) { return glass(n, m, eta, false); };
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) table.push_back(average_over_facets(node_value(x, 16), node_value(y, 16), kSamples, value));
  }
  print("kGgxGemInsideE", table, "The dense side again, without light refracted out of the wrong side");

  table.clear();
  for (int z = 0; z < 16; ++z) {
    const float eta = index_from_f0(sqr(sqr(node_value(z, 16, 0.99f)))), f0 = f0_from_index(eta);
    const auto value = [=](const Node &n, const Vec3 &m) {
      return schlick_position(n, m, (fresnel_dielectric(dot(n.wo, m), eta) - f0) / (1 - f0));
    };
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) table.push_back(average_over_facets(node_value(x, 16), node_value(y, 16), kSamples, value));
  }
  print("kGgxDielectricS", table, "Mean position of the dielectric reflectance between f0 and 1, [z][cos][roughness]");
  table.clear();
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      table.push_back(average_over_facets(node_value(x, 16), node_value(y, 16), kSamples, [](const Node &n, const Vec3 &m) {
        return schlick_position(n, m, pow5(1 - dot(n.wo, m)));
      }));
  print("kGgxSchlickS", table, "Mean position of Schlick's reflectance between f0 and 1, [cos][roughness]");
}
