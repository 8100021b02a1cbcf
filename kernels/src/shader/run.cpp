// SPDX-License-Identifier: GPL-3.0-or-later
// The interpreter: one instruction after the other, each a line or a function of its own.
#include "bsdf/lobes.h"
#include "scene/scene.h"
#include "shader/colour_nodes.h"
#include "shader/image_lookup.h"
#include "shader/maths.h"
#include "shader/noise.h"
#include "shader/patterns.h"
#include "shader/point_inputs.h"
#include "shader/registers.h"
#include "shader/scene_free.h"
#include "shader/voronoi.h"

namespace opal {
namespace {

// What lobes are wanted for. Values: none, only registers.
enum class Purpose { Surface, Emission, Transparency, Values };

struct Run {
  const Scene *scene;  // null: images are grey
  const Program &program;
  const ShadingPoint &sp;
  Registers r;
  Purpose purpose = Purpose::Values;
  ClosureSet *set = nullptr;
  Vec3 sum;  // Transparency
};

void execute(Run &run, const Program::Code &code);

const Float4 *constants_of(const Program &p) { return reinterpret_cast<const Float4 *>(p.constants.data()); }

Vec3 finite(const Vec3 &v) { return is_finite(v) ? v : Vec3{}; }
float finite(float x, float fallback = 0) { return std::isfinite(x) ? x : fallback; }
int whole(float x) { return std::isfinite(x) ? int(clamp(x, -1e6f, 1e6f)) : 0; }

Vec3 transform(const Transform &t, int mode, const Vec3 &v) {
  switch (mode) {
    case OPAL_TRANSFORM_VECTOR: return t.vector(v);
    case OPAL_TRANSFORM_NORMAL: return safe_normalize(t.transposed_vector(v), v);
    case OPAL_TRANSFORM_PROJECT: {
      const Vec3 q = t.point(v);
      return q.z != 0 ? Vec3{q.x / q.z, q.y / q.z, 0} : Vec3{};
    }
    default: return t.point(v);
  }
}

Vec3 separate(int mode, const Vec3 &c) {
  return mode == OPAL_COLOR_HSV ? rgb_to_hsv(c) : mode == OPAL_COLOR_HSL ? rgb_to_hsl(c) : c;
}
Vec3 combine(int mode, const Vec3 &c) {
  return mode == OPAL_COLOR_HSV ? hsv_to_rgb(c) : mode == OPAL_COLOR_HSL ? hsl_to_rgb(c) : c;
}

Vec3 mix(const Run &run, const opal_instruction &c) {
  const int flags = c.in[3];
  const Vec3 a = run.r.xyz(c.in[1]), b = run.r.xyz(c.in[2]);
  Vec3 result;
  if (flags & OPAL_MIX_FLAG_VECTOR_FACTOR) {
    Vec3 t = run.r.xyz(c.in[0]);
    if (flags & OPAL_MIX_FLAG_CLAMP_FACTOR) t = {saturate(t.x), saturate(t.y), saturate(t.z)};
    result = a * (Vec3{1, 1, 1} - t) + b * t;
  } else {
    const float t = run.r.scalar(c.in[0]);
    result = blend(c.mode, flags & OPAL_MIX_FLAG_CLAMP_FACTOR ? saturate(t) : t, a, b);
  }
  if (flags & OPAL_MIX_FLAG_CLAMP_RESULT) result = {saturate(result.x), saturate(result.y), saturate(result.z)};
  return result;
}

Float4 map_range(const Run &run, const opal_instruction &c) {
  const auto scalar = [&](int i) { return run.r.scalar(c.in[i]); };
  const auto xyz = [&](int i) { return run.r.xyz(c.in[i]); };
  const bool clamp_result = c.in[6] & 2;
  if (c.in[6] & 1)
    return vector(
        node_vector_map_range(c.mode, xyz(0), xyz(1), xyz(2), xyz(3), xyz(4), run.r.xyz(c.in[5], {4, 4, 4}), clamp_result));
  const float low = scalar(3), high = scalar(4);
  const float value = node_map_range(c.mode, scalar(0), scalar(1), scalar(2), low, high, run.r.scalar(c.in[5], 4));
  return number(clamp_result ? clamp(value, std::min(low, high), std::max(low, high)) : value);
}

float clamp_node(int mode, float value, float low, float high) {
  if (mode == 1 && low > high) std::swap(low, high);
  return std::fmin(std::fmax(value, low), high);
}

// One lane (lane < 4) or all four of a table at factor t.
Float4 table_lookup(const Float4 *table, int size, int mode, float t) {
  if ((mode & OPAL_TABLE_EXTRAPOLATE) && size > 1 && (t < 0 || t > 1)) {
    const Float4 end = t < 0 ? table[0] : table[size - 1], before = t < 0 ? table[1] : table[size - 2];
    return end + (end - before) * ((t < 0 ? -t : t - 1) * float(size - 1));
  }
  const float x = std::isfinite(t) ? saturate(t) * float(size - 1) : 0.0f;
  const int i = int(x);
  const float f = x - float(i);
  return (mode & OPAL_TABLE_INTERPOLATE) && f > 0 ? table[i] * (1 - f) + table[i + 1] * f : table[i];
}

Float4 table(const Run &run, const opal_instruction &c) {
  const Float4 *entries = constants_of(run.program) + c.in[1];
  const Float4 &t = run.r[c.in[0]];
  if (!(c.mode & OPAL_TABLE_COMPONENTS)) return table_lookup(entries, c.in[2], c.mode, t.x);
  return {table_lookup(entries, c.in[2], c.mode, t.x).x, table_lookup(entries, c.in[2], c.mode, t.y).y,
          table_lookup(entries, c.in[2], c.mode, t.z).z, 1};
}

// Mikkelsen 2010, "Bump mapping unparametrized surfaces on the GPU": the surface gradient of the height tilts the normal.
Vec3 bump(Run &run, const opal_instruction &c) {
  const Vec3 normal = run.r.xyz(c.in[3], run.sp.ns);
  if (run.purpose == Purpose::Values) return normal;  // heights are taken on the surface as it is
  const Program::Code &height_code = run.program.heights[size_t(c.in[kBumpHeight])];
  if (height_code.empty()) return normal;
  const float step = bump_step(run.sp, run.r.scalar(c.in[4], 1));
  const Frame frame = Frame::from_z(run.sp.ng);
  const Vec3 dx = frame.x * step, dy = frame.y * step;
  const auto height_at = [&](const Vec3 &offset) {
    const ShadingPoint there = displaced(run.sp, offset);
    Float4 variables[OPAL_MAX_REGISTERS];
    Run nearby{run.scene, run.program, there, {run.r.constants, run.r.n_constants, variables}, Purpose::Values, nullptr, {}};
    execute(nearby, height_code);
    return nearby.r.scalar(c.in[0]);
  };
  // Here the height is known, unless a bump within it was not left out as it is nearby.
  const bool nested = std::any_of(height_code.begin(), height_code.end(), [](const auto &i) { return i.op == OPAL_OP_BUMP; });
  const float here = nested ? height_at({}) : run.r.scalar(c.in[0]);
  const float hx = height_at(dx) - here, hy = height_at(dy) - here;
  const Vec3 rx = cross(dy, normal), ry = cross(normal, dx);
  const float det = dot(dx, rx);
  float distance = run.r.scalar(c.in[2]);
  if (c.in[5] == 1) distance = -distance;
  const Vec3 tilted = std::abs(det) * normal - (hx * rx + hy * ry) * (det < 0 ? -distance : distance);
  const float strength = std::max(run.r.scalar(c.in[1]), 0.0f);
  const Vec3 unit = safe_normalize(tilted, {});
  if (!is_finite(unit) || length_squared(unit) == 0) return normal;
  return safe_normalize(unit * strength + normal * (1 - strength), normal);
}

Float4 image_at(const Run &run, const opal_instruction &c, const ImageSettings &settings, Vec2 uv) {
  if (!run.scene) return {0.5f, 0.5f, 0.5f, 1};
  int32_t index = c.in[1];
  if (c.in[6] >= 0) {  // UDIM: the tile that (u, v) lies in
    const float column = std::floor(uv.x), row = std::floor(uv.y);
    if (!(column >= 0 && column < 10 && row >= 0 && row < 100)) return {};
    const float tile = 1001 + column + 10 * row;
    index = -1;
    const Float4 *tiles = constants_of(run.program) + c.in[6];
    for (int i = 0; i < c.in[7]; ++i)
      if (tiles[i].x == tile) index = int32_t(tiles[i].y);
    uv = {uv.x - column, uv.y - row};
  }
  return index >= 0 ? lookup_image(run.scene->images[size_t(index)], settings, uv.x, uv.y) : Float4{};
}

Float4 image(const Run &run, const opal_instruction &c) {
  if (run.scene && c.in[1] < 0 && c.in[6] < 0) return {1, 0, 1, 1};  // a missing image is magenta
  const Vec3 p = run.r.xyz(c.in[0]);
  const ImageSettings settings{c.in[2], c.in[3], c.in[4]};
  switch (c.mode) {
    case OPAL_PROJECT_SPHERE: return image_at(run, c, settings, project_sphere(p));
    case OPAL_PROJECT_TUBE: return image_at(run, c, settings, project_tube(p));
    case OPAL_PROJECT_EQUIRECTANGULAR: return image_at(run, c, settings, project_equirectangular(p));
    case OPAL_PROJECT_MIRROR_BALL: return image_at(run, c, settings, project_mirror_ball(p));
    case OPAL_PROJECT_BOX: {
      const Vec3 n = normal_to_object(run.sp, run.sp.ns);
      const Vec3 w = box_weights(n, run.r.scalar(c.in[5], 0));
      Float4 sum{};
      // No side shows the image mirrored.
      if (w.x > 0) sum = sum + w.x * image_at(run, c, settings, {n.x < 0 ? 1 - p.y : p.y, p.z});
      if (w.y > 0) sum = sum + w.y * image_at(run, c, settings, {n.y > 0 ? 1 - p.x : p.x, p.z});
      if (w.z > 0) sum = sum + w.z * image_at(run, c, settings, {n.z > 0 ? 1 - p.y : p.y, p.x});
      return sum;
    }
    default: return image_at(run, c, settings, {p.x, p.y});
  }
}

void noise(const Run &run, const opal_instruction &c) {
  const auto in = [&](int i) { return run.r.scalar(c.in[i]); };
  Fractal f;
  f.type = c.mode;
  f.detail = clamp(finite(in(3)), 0, 15), f.roughness = std::max(finite(in(4)), 0.0f), f.lacunarity = in(5);
  f.offset = in(6), f.gain = in(7), f.normalize = c.in[10] & 1;
  const float scale = in(2);
  Vec3 color;
  const float value = noise_texture(f, c.in[9], run.r.xyz(c.in[0]) * scale, in(1) * scale, in(8), c.in[10] & 2, color);
  run.r.write(c.out) = number(value);
  run.r.write(c.out + 1) = vector(color, 1);
}

void voronoi(const Run &run, const opal_instruction &c) {
  const auto in = [&](int i) { return finite(run.r.scalar(c.in[i])); };
  const Voronoi settings{c.mode, c.in[10], in(3), in(4), in(5), in(6), in(7), in(8), c.in[11] != 0, c.in[12] == 1};
  const VoronoiSample s = voronoi_texture(settings, c.in[9], run.r.xyz(c.in[0]), in(1), in(2));
  run.r.write(c.out) = number(s.distance);
  run.r.write(c.out + 1) = vector(s.color, 1);
  run.r.write(c.out + 2) = s.position;
  run.r.write(c.out + 3) = number(s.radius);
}

float wave(const Run &run, const opal_instruction &c) {
  const auto in = [&](int i) { return finite(run.r.scalar(c.in[i])); };
  return wave({c.in[7] != 0, c.in[8], c.in[9], in(2), in(3), in(4), in(5), in(6)}, run.r.xyz(c.in[0]) * in(1));
}

void brick(const Run &run, const opal_instruction &c) {
  const auto in = [&](int i) { return run.r.scalar(c.in[i]); };
  const Float4 &pattern = run.r[c.in[10]];
  const Brick b{in(5), in(6), in(7), in(8), in(9), pattern.x, pattern.z, whole(pattern.y), whole(pattern.w)};
  const BrickSample s = brick(b, run.r.xyz(c.in[0]) * in(4));
  const Vec3 color = lerp(run.r.xyz(c.in[1]), run.r.xyz(c.in[2]), s.tint);
  run.r.write(c.out) = vector(lerp(color, run.r.xyz(c.in[3]), s.mortar), 1);
  run.r.write(c.out + 1) = number(s.mortar);
}

// ---- Lobes ----

PrincipledInputs principled_inputs(const Registers &r, const opal_instruction &c) {
  const Float4 &specular = r[c.in[5]], &coat = r[c.in[6]], &sheen = r[c.in[7]], &emission = r[c.in[8]];
  const Float4 &base = r[c.in[9]], &body = r[c.in[10]], &layers = r[c.in[11]], &film = r[c.in[12]];
  PrincipledInputs in;
  in.base_color = finite(r.xyz(c.in[1]));
  in.normal = finite(r.xyz(c.in[2], {}));
  in.tangent = finite(r.xyz(c.in[3], {}));
  in.coat_normal = finite(r.xyz(c.in[4], {}));
  in.specular_tint = finite(specular.xyz()), in.specular_ior_level = finite(specular.w);
  in.coat_tint = finite(coat.xyz()), in.coat_weight = finite(coat.w);
  in.sheen_tint = finite(sheen.xyz()), in.sheen_weight = finite(sheen.w);
  in.emission_color = finite(emission.xyz()), in.emission_strength = finite(emission.w);
  in.metallic = finite(base.x), in.roughness = finite(base.y), in.ior = finite(base.z, 1.5f), in.alpha = finite(base.w, 1);
  in.diffuse_roughness = finite(body.x), in.subsurface_weight = finite(body.y);
  in.anisotropic = finite(body.z), in.anisotropic_rotation = finite(body.w);
  in.transmission_weight = finite(layers.x), in.coat_roughness = finite(layers.y), in.coat_ior = finite(layers.z, 1.5f);
  in.sheen_roughness = finite(layers.w);
  in.thin_film_thickness = finite(film.x), in.thin_film_ior = finite(film.y, 1.33f);
  in.multiscatter = c.mode == 1;
  return in;
}

void lobe(Run &run, const opal_instruction &c) {
  const Registers &r = run.r;
  const Vec3 weight = finite(r.xyz(c.in[0], {1, 1, 1}));
  const auto color = [&](int i) { return finite(r.xyz(c.in[i])); };
  const auto direction = [&](int i) { return finite(r.xyz(c.in[i], {})); };
  const auto value = [&](int i) { return finite(r.scalar(c.in[i])); };
  if (run.purpose == Purpose::Transparency) {
    if (c.op == OPAL_OP_TRANSPARENT) run.sum += weight * color(1);
    if (c.op == OPAL_OP_PRINCIPLED) run.sum += weight * (1 - saturate(finite(r[c.in[9]].w, 1)));
    return;
  }
  if (run.purpose == Purpose::Emission && c.op == OPAL_OP_EMISSION) {
    run.sum += weight * color(1) * value(2);
    return;
  }
  if (run.purpose == Purpose::Emission && c.op == OPAL_OP_PRINCIPLED && r[c.in[6]].w == 0 && r[c.in[7]].w == 0) {
    // Neither coat nor sheen above: alpha alone weakens it.
    run.sum += weight * finite(r.xyz(c.in[8])) * (finite(r[c.in[8]].w) * saturate(finite(r[c.in[9]].w, 1)));
    return;
  }
  if (!run.set) return;
  ClosureSet &set = *run.set;
  const ShadingPoint &sp = run.sp;
  switch (c.op) {
    case OPAL_OP_DIFFUSE: add_diffuse(set, sp, weight, color(1), value(2), direction(3)); break;
    case OPAL_OP_TRANSLUCENT: add_translucent(set, sp, weight, color(1), direction(2)); break;
    case OPAL_OP_GLOSSY:
      add_glossy(set, sp, weight, color(1), value(2), value(3), value(4), direction(5), direction(6), c.in[7] == 1);
      break;
    case OPAL_OP_METALLIC: {
      const auto add = c.mode == 1 ? add_metallic_conductor : add_metallic_f82;
      add(set, sp, weight, color(1), color(2), value(3), value(4), value(5), direction(6), direction(7), c.in[8] == 1);
      break;
    }
    case OPAL_OP_GLASS: add_glass(set, sp, weight, color(1), value(2), value(3), direction(4), c.in[5] == 1); break;
    case OPAL_OP_REFRACTION: add_refraction(set, sp, weight, color(1), value(2), value(3), direction(4)); break;
    case OPAL_OP_TRANSPARENT: add_transparent(set, weight, color(1)); break;
    case OPAL_OP_SHEEN: add_sheen(set, sp, weight, color(1), value(2), direction(3)); break;
    case OPAL_OP_EMISSION: add_emission(set, weight, color(1), value(2)); break;
    case OPAL_OP_HOLDOUT: add_holdout(set, weight); break;
    case OPAL_OP_PRINCIPLED: add_principled(set, sp, weight, principled_inputs(r, c)); break;
    default: break;
  }
}

void execute(Run &run, const Program::Code &code) {
  const Registers &r = run.r;
  for (const opal_instruction &c : code) {
    const auto in = [&](int i) -> const Float4 & { return r[c.in[i]]; };
    const auto xyz = [&](int i) { return r.xyz(c.in[i]); };
    const auto scalar = [&](int i) { return r.scalar(c.in[i]); };
    const auto normal = [&](int i) { return r.xyz(c.in[i], run.sp.ns); };
    switch (c.op) {
      case OPAL_OP_GREY: r.write(c.out) = number(c.mode == OPAL_GREY_AVERAGE ? average(xyz(0)) : luminance(xyz(0))); break;
      case OPAL_OP_MATH:
        r.write(c.out) = number(node_math(c.mode, scalar(0), r.scalar(c.in[1], 0), r.scalar(c.in[2], 0)));
        break;
      case OPAL_OP_VECTOR_MATH:
        r.write(c.out) = vector(node_vector_math(c.mode, xyz(0), r.xyz(c.in[1], {}), r.xyz(c.in[2], {}), r.scalar(c.in[3], 1)));
        break;
      case OPAL_OP_MIX: r.write(c.out) = vector(mix(run, c), 1); break;
      case OPAL_OP_MAP_RANGE: r.write(c.out) = map_range(run, c); break;
      case OPAL_OP_CLAMP: r.write(c.out) = number(clamp_node(c.mode, scalar(0), scalar(1), scalar(2))); break;
      case OPAL_OP_MAPPING: r.write(c.out) = vector(node_mapping(c.mode, xyz(0), xyz(1), xyz(2), xyz(3))); break;
      case OPAL_OP_VECTOR_ROTATE:
        r.write(c.out) = vector(node_vector_rotate(c.mode, xyz(0), xyz(1), r.xyz(c.in[2], {}), r.scalar(c.in[3], 0),
                                                   r.xyz(c.in[4], {}), c.in[5] == 1));
        break;
      case OPAL_OP_TRANSFORM: {
        Transform t;
        for (int i = 0; i < 12; ++i) t.m[i] = constants_of(run.program)[c.in[1] + i / 4][i % 4];
        r.write(c.out) = vector(transform(t, c.mode, xyz(0)));
        break;
      }
      case OPAL_OP_TO_OBJECT: {
        const PointTransforms t = point_transforms(run.sp);
        r.write(c.out) = vector(transform(c.mode == OPAL_TRANSFORM_NORMAL ? t.to_world : t.to_object, c.mode, xyz(0)));
        break;
      }
      case OPAL_OP_TO_WORLD: {
        const PointTransforms t = point_transforms(run.sp);
        r.write(c.out) = vector(transform(c.mode == OPAL_TRANSFORM_NORMAL ? t.to_object : t.to_world, c.mode, xyz(0)));
        break;
      }
      case OPAL_OP_SEPARATE: r.write(c.out) = number(c.in[1] == 3 ? in(0).w : separate(c.mode, xyz(0))[c.in[1]]); break;
      case OPAL_OP_COMBINE: r.write(c.out) = vector(combine(c.mode, {scalar(0), scalar(1), scalar(2)}), 1); break;
      case OPAL_OP_PACK:
        r.write(c.out) =
            c.mode == 1 ? vector(xyz(0), scalar(1)) : Float4{scalar(0), scalar(1), r.scalar(c.in[2], 0), r.scalar(c.in[3], 0)};
        break;

      case OPAL_OP_HUE_SATURATION:
        r.write(c.out) = vector(hue_saturation(scalar(0), xyz(1), scalar(2), scalar(3), scalar(4)), 1);
        break;
      case OPAL_OP_INVERT: r.write(c.out) = vector(lerp(xyz(1), Vec3{1, 1, 1} - xyz(1), scalar(0)), 1); break;
      case OPAL_OP_GAMMA: r.write(c.out) = vector(gamma_correct(xyz(0), scalar(1)), 1); break;
      case OPAL_OP_BRIGHT_CONTRAST: r.write(c.out) = vector(bright_contrast(xyz(0), scalar(1), scalar(2)), 1); break;
      case OPAL_OP_TABLE: r.write(c.out) = table(run, c); break;

      case OPAL_OP_COORDINATE: r.write(c.out) = vector(texture_coordinate(run.sp, c.mode)); break;
      case OPAL_OP_ATTRIBUTE: r.write(c.out) = attribute(run.sp, c.in[0], c.mode, c.in[1] < 0 ? Float4{} : in(1)); break;
      case OPAL_OP_GEOMETRY: r.write(c.out) = geometry_input(run.sp, c.mode); break;
      case OPAL_OP_OBJECT_INFO: r.write(c.out) = object_input(run.sp, c.mode); break;
      case OPAL_OP_LIGHT_PATH: r.write(c.out) = number(light_path_input(run.sp, c.mode)); break;
      case OPAL_OP_FRESNEL: r.write(c.out) = number(fresnel_input(run.sp, scalar(0), normal(1))); break;
      case OPAL_OP_LAYER_WEIGHT: r.write(c.out) = number(layer_weight(run.sp, c.mode == 1, scalar(0), normal(1))); break;
      case OPAL_OP_NORMAL_MAP:
        r.write(c.out) = vector(normal_map(run.sp, c.mode, xyz(0), scalar(1), c.in[2], c.in[3] == 1));
        break;
      case OPAL_OP_BUMP: r.write(c.out) = vector(bump(run, c)); break;
      case OPAL_OP_TANGENT: r.write(c.out) = vector(tangent_input(run.sp, c.mode, c.in[0])); break;

      case OPAL_OP_IMAGE: r.write(c.out) = image(run, c); break;
      case OPAL_OP_CHECKER: {
        const bool first = checker(xyz(0) * scalar(3));
        const Float4 color = in(first ? 1 : 2);
        r.write(c.out) = color;
        r.write(c.out + 1) = number(first);
        break;
      }
      case OPAL_OP_NOISE: noise(run, c); break;
      case OPAL_OP_VORONOI: voronoi(run, c); break;
      case OPAL_OP_WAVE: r.write(c.out) = number(wave(run, c)); break;
      case OPAL_OP_MAGIC: {
        const Vec3 color = magic(xyz(0) * scalar(1), c.in[3], scalar(2));
        r.write(c.out) = vector(color, 1);
        r.write(c.out + 1) = number(average(color));
        break;
      }
      case OPAL_OP_BRICK: brick(run, c); break;
      case OPAL_OP_GRADIENT: r.write(c.out) = number(gradient(c.mode, xyz(0))); break;
      case OPAL_OP_WHITE_NOISE: {
        Vec3 color;
        const float value = white_noise(c.in[2], xyz(0), scalar(1), color);
        r.write(c.out) = number(value);
        r.write(c.out + 1) = vector(color, 1);
        break;
      }
      default: lobe(run, c);
    }
  }
}

// For the world the direction looked in takes the place of everything that a surface has.
ShadingPoint seen_from_inside(const ShadingPoint &sp) {
  ShadingPoint q = sp;
  q.ng = q.ns = q.wo = -safe_normalize(sp.p, {0, 0, 1});
  q.instance = nullptr;
  return q;
}

// Runs `code` at `sp` for `purpose`; what Transparency adds up is returned.
Vec3 run_code(const Scene *scene, const Program &program, const Program::Code &code, const ShadingPoint &sp, Purpose purpose,
              ClosureSet *set) {
  Float4 variables[OPAL_MAX_REGISTERS];
  const Registers registers{constants_of(program), program.n_constants, variables};
  const auto at = [&](const ShadingPoint &point) {
    Run run{scene, program, point, registers, purpose, set, {}};
    execute(run, code);
    return run.sum;
  };
  return sp.mesh ? at(sp) : at(seen_from_inside(sp));
}

void clear(ClosureSet &set) {
  set.count = 0;
  set.emission = {};
  set.holdout = 0;
  set.albedo = {};
}

Vec3 emitted(const Scene *scene, const Program &program, const ShadingPoint &sp) {
  const auto run = [&](ClosureSet *set) { return run_code(scene, program, program.emission_code, sp, Purpose::Emission, set); };
  if (!program.emission_of_layers) return finite(run(nullptr));
  ClosureSet set;  // large: only where layers above tint the emission
  const Vec3 plain = run(&set);
  return finite(plain + set.emission);
}

}  // namespace

void run_surface(const Scene &scene, const Program &program, const ShadingPoint &sp, ClosureSet &out) {
  clear(out);
  run_code(&scene, program, program.code, sp, Purpose::Surface, &out);
  out.emission = finite(out.emission);
}

Vec3 run_transparency(const Scene &scene, const Program &program, const ShadingPoint &sp) {
  if (program.transparency_code.empty()) return {};
  return run_code(&scene, program, program.transparency_code, sp, Purpose::Transparency, nullptr);
}

Vec3 run_emission(const Scene &scene, const Program &program, const ShadingPoint &sp) {
  if (program.emission_code.empty()) return {};
  if (program.constant_emission) return program.emission;
  return emitted(&scene, program, sp);
}

Vec3 estimate_emission(const Program &program) {
  if (program.emission_code.empty()) return {};
  const int n = program.constant_emission ? 1 : 8;
  Vec3 sum;
  for (int i = 0; i < n; ++i) {
    ShadingPoint sp;
    const float sign_x = i & 1 ? 1.0f : -1.0f, sign_y = i & 2 ? 1.0f : -1.0f, sign_z = i & 4 ? 1.0f : -1.0f;
    sp.p = normalize(Vec3{0.31f * sign_x, 0.47f * sign_y, 0.83f * sign_z});
    sp.ray_kind = OPAL_RAY_ALL;
    sp.ray_length = 1;
    sum += emitted(nullptr, program, sp);
  }
  return sum / float(n);
}

}  // namespace opal
