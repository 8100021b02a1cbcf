// SPDX-License-Identifier: GPL-3.0-or-later
#include "shader/voronoi.h"

#include "shader/hash.h"
#include "shader/maths.h"
#include "shader/noise.h"

#include <cfloat>

namespace opal {
namespace {

template <int N>
struct Cell {
  int32_t v[N];
};

template <int N>
Point<N> operator-(Point<N> a, const Point<N> &b) {
  return a + b * -1.0f;
}
template <int N>
Point<N> mix(const Point<N> &a, const Point<N> &b, float t) {
  return a * (1 - t) + b * t;
}
template <int N>
float dot(const Point<N> &a, const Point<N> &b) {
  float s = 0;
  for (int i = 0; i < N; ++i) s += a.v[i] * b.v[i];
  return s;
}

template <int N>
float distance(const Voronoi &s, const Point<N> &a, const Point<N> &b) {
  const Point<N> d = a - b;
  if (N == 1) return std::abs(d.v[0]);
  float sum = 0, most = 0;
  for (float x : d.v) {
    x = std::abs(x);
    most = std::max(most, x);
    sum += s.metric == 0 ? x * x : s.metric == 3 ? std::pow(x, s.exponent) : x;
  }
  switch (s.metric) {
    case 0: return std::sqrt(sum);
    case 1: return sum;
    case 2: return most;
    default: return std::pow(sum, 1 / s.exponent);
  }
}

constexpr float kPcgScale = 1.0f / float(0x7FFFFFFFu);

template <int N>
Point<N> as_point(const Cell<N> &c) {
  Point<N> p;
  for (int i = 0; i < N; ++i) p.v[i] = float(c.v[i]);
  return p;
}

// The random point of a cell, relative to the cell's corner, before `randomness` scales it.
template <int N>
Point<N> random_point(const Voronoi &s, const Cell<N> &c) {
  Point<N> p = as_point(c);
  if constexpr (N == 1) return {{hash_floats({p.v[0]})}};
  if (!s.jenkins) {
    int32_t k[N];
    std::copy_n(c.v, N, k);
    if constexpr (N > 1) pcg<N>(k);
    for (int i = 0; i < N; ++i) p.v[i] = float(k[i]) * kPcgScale;
    return p;
  }
  const float *q = p.v;
  if constexpr (N == 2) return {{hash_floats({q[0], q[1]}), hash_floats({q[0], q[1], 1.0f})}};
  if constexpr (N == 3)
    return {{hash_floats({q[0], q[1], q[2]}), hash_floats({q[0], q[1], q[2], 1.0f}), hash_floats({q[0], q[1], q[2], 2.0f})}};
  if constexpr (N == 4)
    return {{hash_floats({q[0], q[1], q[2], q[3]}), hash_floats({q[3], q[0], q[1], q[2]}),
             hash_floats({q[2], q[3], q[0], q[1]}), hash_floats({q[1], q[2], q[3], q[0]})}};
  return p;
}

template <int N>
Vec3 random_color(const Voronoi &s, const Cell<N> &c) {
  const Point<N> k = as_point(c);
  const float *q = k.v;
  if constexpr (N == 1) return {hash_floats({q[0]}), hash_floats({q[0], 1.0f}), hash_floats({q[0], 2.0f})};
  if constexpr (N == 2)
    if (s.jenkins) return {hash_floats({q[0], q[1]}), hash_floats({q[0], q[1], 1.0f}), hash_floats({q[0], q[1], 2.0f})};
  if constexpr (N == 4) {
    if (s.jenkins)
      return {hash_floats({q[0], q[1], q[2], q[3]}), hash_floats({q[2], q[0], q[3], q[1]}),
              hash_floats({q[3], q[2], q[1], q[0]})};
    const Point<4> p = random_point(s, c);
    return {p.v[0], p.v[1], p.v[2]};
  } else {
    const Point<3> p = random_point<3>(s, {{c.v[0], N > 1 ? c.v[N > 1] : 0, N == 3 ? c.v[N - 1] : 0}});
    return {p.v[0], p.v[1], p.v[2]};
  }
}

// Calls f(offset, point) for the cells within `reach` of `home`, the first coordinate running fastest; `point` is relative to
// the corner of `home`.
template <int N, class F>
void around(const Voronoi &s, const Cell<N> &home, int reach, F f) {
  Cell<N> offset;
  for (int32_t &o : offset.v) o = -reach;
  for (;;) {
    Cell<N> cell;
    Point<N> point;
    for (int i = 0; i < N; ++i)
      cell.v[i] = int32_t(uint32_t(home.v[i]) + uint32_t(offset.v[i])), point.v[i] = float(offset.v[i]);
    f(cell, point + random_point(s, cell) * s.randomness);
    int i = 0;
    while (i < N && ++offset.v[i] > reach) offset.v[i++] = -reach;
    if (i == N) return;
  }
}

template <int N>
struct Octave {
  float distance = 0;
  Vec3 color;
  Point<N> position{};
};

template <int N>
struct Place {
  Cell<N> cell;
  Point<N> corner, local;

  explicit Place(const Point<N> &p) {
    for (int i = 0; i < N; ++i) {
      const float whole = std::floor(p.v[i]);
      cell.v[i] = std::abs(whole) < 2147483520.0f ? int32_t(whole) : 0;
      corner.v[i] = whole;
      local.v[i] = p.v[i] - whole;
    }
  }
};

template <int N>
Octave<N> nearest(const Voronoi &s, const Place<N> &at, int rank) {
  float d[2] = {FLT_MAX, FLT_MAX};
  Cell<N> cell[2] = {at.cell, at.cell};
  Point<N> point[2] = {};
  around<N>(s, at.cell, 1, [&](const Cell<N> &c, const Point<N> &p) {
    const float distance_here = distance(s, p, at.local);
    if (distance_here < d[0]) {
      d[1] = d[0], cell[1] = cell[0], point[1] = point[0];
      d[0] = distance_here, cell[0] = c, point[0] = p;
    } else if (distance_here < d[1]) {
      d[1] = distance_here, cell[1] = c, point[1] = p;
    }
  });
  return {d[rank], random_color(s, cell[rank]), point[rank] + at.corner};
}

template <int N>
Octave<N> smooth_nearest(const Voronoi &s, const Place<N> &at) {
  Octave<N> o;
  bool first = true;
  around<N>(s, at.cell, 2, [&](const Cell<N> &c, const Point<N> &p) {
    const float d = distance(s, p, at.local);
    const float h = first ? 1.0f : smoothstep01(0.5f + 0.5f * (o.distance - d) / s.smoothness);
    first = false;
    float correction = s.smoothness * h * (1 - h);
    o.distance = lerp(o.distance, d, h) - correction;
    correction /= 1 + 3 * s.smoothness;
    o.color = lerp(o.color, random_color(s, c), h) - Vec3{correction, correction, correction};
    o.position = mix(o.position, p, h);
    for (float &x : o.position.v) x -= correction;
  });
  o.position = o.position + at.corner;
  return o;
}

template <int N>
float distance_to_edge(const Voronoi &s, const Point<N> &p) {
  const Place<N> at(p);
  if constexpr (N == 1) {
    float points[3];
    int i = 0;
    around<1>(s, at.cell, 1, [&](const Cell<1> &, const Point<1> &q) { points[i++] = q.v[0]; });
    return std::min(std::abs((points[1] + points[0]) / 2 - at.local.v[0]),
                    std::abs((points[1] + points[2]) / 2 - at.local.v[0]));
  } else {
    Point<N> closest{};
    float least = FLT_MAX;
    around<N>(s, at.cell, 1, [&](const Cell<N> &, const Point<N> &q) {
      const Point<N> to = q - at.local;
      if (const float d = dot(to, to); d < least) least = d, closest = to;
    });
    least = FLT_MAX;
    around<N>(s, at.cell, 1, [&](const Cell<N> &, const Point<N> &q) {
      const Point<N> to = q - at.local, across = to - closest;
      const float l2 = dot(across, across);
      if (l2 > 0.0001f) least = std::min(least, dot((closest + to) * 0.5f, across * (1 / std::sqrt(l2))));
    });
    return least;
  }
}

// Half the distance between the nearest point and the point nearest to that.
template <int N>
float sphere_radius(const Voronoi &settings, const Point<N> &p) {
  Voronoi s = settings;
  s.metric = 0;
  const Place<N> at(p);
  Cell<N> home = at.cell;
  Point<N> closest{};
  float least = FLT_MAX;
  around<N>(s, at.cell, 1, [&](const Cell<N> &c, const Point<N> &q) {
    if (const float d = distance(s, q, at.local); d < least) least = d, closest = q, home = c;
  });
  Point<N> shift;
  for (int i = 0; i < N; ++i) shift.v[i] = float(int32_t(uint32_t(home.v[i]) - uint32_t(at.cell.v[i])));
  least = FLT_MAX;
  around<N>(s, home, 1, [&](const Cell<N> &c, const Point<N> &q) {
    if (std::equal(c.v, c.v + N, home.v)) return;
    least = std::min(least, distance(s, q + shift, closest));
  });
  return least / 2;
}

template <int N>
Octave<N> octave(const Voronoi &s, const Point<N> &p) {
  const Place<N> at(p);
  if (s.feature == OPAL_VORONOI_F2) return nearest(s, at, 1);
  if (s.feature == OPAL_VORONOI_SMOOTH_F1 && s.smoothness != 0) return smooth_nearest(s, at);
  return nearest(s, at, 0);
}

template <int N>
Octave<N> fractal(const Voronoi &s, const Point<N> &p) {
  Octave<N> sum;
  float amplitude = 1, total = 0, scale = 1;
  for (int i = 0; i <= int(std::ceil(s.detail)); ++i) {
    const Octave<N> o = octave(s, p * scale);
    if (s.detail == 0 || s.roughness == 0) {
      total = 1, sum = o;
      break;
    }
    // The last octave counts for the fractional part of the detail.
    const float part = float(i) <= s.detail ? 1.0f : s.detail - std::floor(s.detail);
    if (part == 0) break;
    total += amplitude * part;
    sum.distance += o.distance * amplitude * part;
    sum.color += o.color * (amplitude * part);
    sum.position = mix(sum.position, mix(sum.position, o.position * (1 / scale), amplitude), part);
    scale *= s.lacunarity;
    amplitude *= s.roughness;
  }
  if (s.normalize) {
    Point<N> corner{};
    for (float &x : corner.v) x = 0.5f + 0.5f * s.randomness;
    const float most = distance(s, Point<N>{}, corner) * (s.feature == OPAL_VORONOI_F2 ? 2.0f : 1.0f);
    sum.distance /= total * most;
    sum.color = sum.color / total;
  }
  return sum;
}

template <int N>
float fractal_edge(const Voronoi &s, const Point<N> &p) {
  const float most = 0.5f + 0.5f * s.randomness;
  float amplitude = 1, total = most, scale = 1, result = 8;
  for (int i = 0; i <= int(std::ceil(s.detail)); ++i) {
    const float d = distance_to_edge(s, p * scale);
    if (s.detail == 0 || s.roughness == 0) {
      result = d;
      break;
    }
    const float total_next = lerp(total, most / scale, amplitude);
    const float next = lerp(result, std::min(result, d / scale), amplitude);
    if (float(i) <= s.detail) {
      total = total_next, result = next;
      scale *= s.lacunarity;
      amplitude *= s.roughness;
    } else if (const float rest = s.detail - std::floor(s.detail); rest != 0) {
      total = lerp(total, total_next, rest);
      result = lerp(result, std::min(result, next), rest);
    }
  }
  return s.normalize ? result / total : result;
}

template <int N>
VoronoiSample sample(const Voronoi &s, const Point<N> &p, float scale) {
  VoronoiSample out;
  if (s.feature == OPAL_VORONOI_DISTANCE_TO_EDGE) {
    out.distance = fractal_edge(s, p);
  } else if (s.feature == OPAL_VORONOI_N_SPHERE_RADIUS) {
    out.radius = sphere_radius(s, p);
  } else {
    const Octave<N> o = fractal(s, p);
    out.distance = o.distance;
    out.color = o.color;
    const Point<N> q = scale != 0 ? o.position * (1 / scale) : Point<N>{};
    if constexpr (N == 1) out.position.w = q.v[0];
    if constexpr (N >= 2) out.position.x = q.v[0], out.position.y = q.v[1];
    if constexpr (N >= 3) out.position.z = q.v[2];
    if constexpr (N == 4) out.position.w = q.v[3];
  }
  return out;
}

}  // namespace

VoronoiSample voronoi_texture(const Voronoi &settings, int dimensions, const Vec3 &p_in, float w_in, float scale) {
  Voronoi s = settings;
  s.detail = clamp(s.detail, 0, 15);
  s.roughness = saturate(s.roughness);
  s.randomness = saturate(s.randomness);
  s.smoothness = clamp(s.smoothness / 2, 0, 0.5f);
  const Vec3 p = p_in * scale;
  const float w = w_in * scale;
  if (!is_finite(p) || !std::isfinite(w)) return {};
  switch (dimensions) {
    case 1: return sample<1>(s, {{w}}, scale);
    case 2: return sample<2>(s, {{p.x, p.y}}, scale);
    case 3: return sample<3>(s, {{p.x, p.y, p.z}}, scale);
    default: return sample<4>(s, {{p.x, p.y, p.z, w}}, scale);
  }
}

}  // namespace opal
