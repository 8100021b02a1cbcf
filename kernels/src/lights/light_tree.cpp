// SPDX-License-Identifier: GPL-3.0-or-later
// See light_tree.h. The split minimises Conty & Kulla's surface-area orientation heuristic over twelve buckets.
#include "lights/light_tree.h"

#include "lights/directions.h"

#include <cstddef>

namespace opal {
namespace {

constexpr int kBuckets = 12;
constexpr int kDeepest = 48;            // deeper nodes split in the middle
constexpr size_t kOneAxisAbove = 4096;  // larger groups look at their longest axis only

float safe_acos(float x) { return std::acos(clamp(x, -1, 1)); }

// The measure of directions that a cone of normals and its falloff cover.
float orientation_measure(const LightBounds &b) {
  const float o = b.theta_o, w = std::min(o + b.theta_e, kPi);
  const float s = std::sin(o), c = std::cos(o);
  return 2 * kPi * (1 - c) + 0.5f * kPi * (2 * w * s - std::cos(o - 2 * w) - 2 * o * s + c);
}

float surface_area(const Bounds &b) {
  const Vec3 d = b.high - b.low;
  return 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
}

float cost(const LightBounds &b, float regularity) {
  // Points and flat groups have an area of zero: a trace of the diagonal keeps them in order.
  const float diagonal2 = length_squared(b.box.high - b.box.low);
  return b.power * orientation_measure(b) * regularity * (surface_area(b.box) + 0.05f * diagonal2 + 1e-12f);
}

// cos(max(0, a - b)) of angles given by sine and cosine.
float cos_of_difference(float sin_a, float cos_a, float sin_b, float cos_b) {
  return cos_a > cos_b ? 1.0f : cos_a * cos_b + sin_a * sin_b;
}
float sin_of_difference(float sin_a, float cos_a, float sin_b, float cos_b) {
  return cos_a > cos_b ? 0.0f : sin_a * cos_b - cos_a * sin_b;
}

}  // namespace

LightBounds merge(const LightBounds &a, const LightBounds &b) {
  if (a.power <= 0 && a.box.empty()) return b;
  if (b.power <= 0 && b.box.empty()) return a;
  LightBounds m;
  m.box = a.box;
  m.box.extend(b.box);
  m.power = a.power + b.power;
  m.two_sided = a.two_sided || b.two_sided;
  m.receivers = a.receivers | b.receivers;
  m.theta_e = std::max(a.theta_e, b.theta_e);
  // The smallest cone round both cones of normals.
  const LightBounds &wide = a.theta_o >= b.theta_o ? a : b, &narrow = a.theta_o >= b.theta_o ? b : a;
  const float between = safe_acos(dot(wide.axis, narrow.axis));
  m.axis = wide.axis, m.theta_o = wide.theta_o;
  if (std::min(between + narrow.theta_o, kPi) <= wide.theta_o) return m;
  m.theta_o = 0.5f * (wide.theta_o + between + narrow.theta_o);
  const Vec3 pivot = narrow.axis - wide.axis * dot(narrow.axis, wide.axis);
  const float l = length(pivot);
  if (m.theta_o >= kPi || l < 1e-6f) {
    m.theta_o = kPi;
    return m;
  }
  const float turn = m.theta_o - wide.theta_o;
  m.axis = normalize(wide.axis * std::cos(turn) + pivot * (std::sin(turn) / l));
  return m;
}

void LightBounds::finish() {
  sin_o = std::sin(theta_o), cos_o = std::cos(theta_o);
  // A hair of tolerance: at the very edge rounding must not leave out what sampling can still find.
  cos_e = std::cos(std::min(theta_e + 1e-3f, kPi));
}

float importance(const LightBounds &b, const Receiver &r) {
  if (r.light_group >= 0 && !(b.receivers >> (r.light_group & 63) & 1)) return 0;
  const Vec3 centre = b.box.centre();
  const float radius = b.box.radius();
  const Vec3 to_lights = centre - r.p;
  const float d2 = length_squared(to_lights), nearest2 = std::max(d2, sqr(radius));
  if (!(nearest2 > 0)) return b.power;
  const bool within = d2 <= sqr(radius);
  const Vec3 w = d2 > 0 ? to_lights / std::sqrt(d2) : Vec3{0, 0, 1};
  const float sin_u = within ? 0.0f : radius / std::sqrt(d2), cos_u = within ? -1.0f : safe_sqrt(1 - sqr(sin_u));

  // At the light: the smallest angle to a normal of the group.
  float cos_w = -dot(w, b.axis);
  if (b.two_sided) cos_w = std::abs(cos_w);
  const float sin_w = safe_sqrt(1 - sqr(cos_w));
  const float cos_x = cos_of_difference(sin_w, cos_w, b.sin_o, b.cos_o);
  const float sin_x = sin_of_difference(sin_w, cos_w, b.sin_o, b.cos_o);
  const float cos_leaving = within ? 1.0f : cos_of_difference(sin_x, cos_x, sin_u, cos_u);
  if (cos_leaving < b.cos_e) return 0;
  float value = b.power * std::max(cos_leaving, 1e-3f) / nearest2;

  // At the receiver.
  if (length_squared(r.normal) > 0 && !within) {
    float cos_i = dot(w, r.normal);
    if (r.transmissive) cos_i = std::abs(cos_i);
    value *= std::max(cos_of_difference(safe_sqrt(1 - sqr(cos_i)), cos_i, sin_u, cos_u), kSmallestCosine);
  }
  return value;
}

void LightTree::build(std::vector<LightBounds> lights, const std::atomic<bool> &cancel) {
  nodes_.clear();
  leaf_of_.assign(lights.size(), 0);
  if (lights.empty()) return;
  nodes_.reserve(2 * lights.size());
  for (LightBounds &b : lights) b.finish();
  std::vector<uint32_t> order(lights.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  build_node(order, 0, order.size(), 0, 0, lights, cancel);
}

uint32_t LightTree::build_node(std::vector<uint32_t> &order, size_t first, size_t last, uint32_t parent, int depth,
                               const std::vector<LightBounds> &lights, const std::atomic<bool> &cancel) {
  const uint32_t me = uint32_t(nodes_.size());
  nodes_.push_back({});
  nodes_[me].parent = parent;
  if (last - first == 1 || cancel.load(std::memory_order_relaxed)) {
    nodes_[me].bounds = lights[order[first]];
    nodes_[me].light = order[first];
    leaf_of_[order[first]] = me;
    return me;
  }
  Bounds centres, box;
  for (size_t i = first; i < last; ++i) {
    centres.extend(lights[order[i]].box.centre());
    box.extend(lights[order[i]].box);
  }
  const Vec3 extent = centres.high - centres.low, size = box.high - box.low;
  const float longest = max_component(extent);
  float best = kInfinity;
  int best_axis = -1, best_bucket = 0;
  const auto bucket_of = [&](uint32_t light, int axis) {
    const float x = (lights[light].box.centre()[axis] - centres.low[axis]) / extent[axis];
    return std::clamp(int(x * kBuckets), 0, kBuckets - 1);
  };
  for (int axis = 0; axis < 3 && depth < kDeepest; ++axis) {
    if (!(extent[axis] > 0) || (last - first > kOneAxisAbove && extent[axis] < longest)) continue;
    LightBounds buckets[kBuckets], above[kBuckets];
    for (size_t i = first; i < last; ++i) {
      LightBounds &b = buckets[bucket_of(order[i], axis)];
      b = merge(b, lights[order[i]]);
    }
    above[kBuckets - 1] = buckets[kBuckets - 1];
    for (int k = kBuckets - 2; k > 0; --k) above[k] = merge(buckets[k], above[k + 1]);
    const float regularity = max_component(size) / std::max(size[axis], 1e-12f);
    LightBounds below;
    for (int k = 0; k + 1 < kBuckets; ++k) {
      below = merge(below, buckets[k]);
      if (below.box.empty() || above[k + 1].box.empty()) continue;
      const float c = cost(below, regularity) + cost(above[k + 1], regularity);
      if (c < best) best = c, best_axis = axis, best_bucket = k;
    }
  }
  size_t middle = (first + last) / 2;
  const auto at = [&](size_t i) { return order.begin() + std::ptrdiff_t(i); };
  if (best_axis >= 0)
    middle = size_t(std::partition(at(first), at(last), [&](uint32_t l) { return bucket_of(l, best_axis) <= best_bucket; }) -
                    order.begin());
  if (middle == first || middle == last) middle = (first + last) / 2;
  const uint32_t left = build_node(order, first, middle, me, depth + 1, lights, cancel);
  const uint32_t right = build_node(order, middle, last, me, depth + 1, lights, cancel);
  nodes_[me].right = right;
  nodes_[me].bounds = merge(nodes_[left].bounds, nodes_[right].bounds);
  nodes_[me].bounds.finish();
  return me;
}

void LightTree::cut(const Receiver &receiver, Cut &out) const {
  out.count = 0, out.total = 0;
  if (nodes_.empty()) return;
  // How much a split may tell: the group's weight times the solid angle it fills, roughly.
  float gain[kCutSize];
  const auto place = [&](int i, uint32_t node) {
    const LightBounds &b = nodes_[node].bounds;
    out.nodes[i] = node;
    out.importance[i] = importance(b, receiver);
    const float r2 = sqr(b.box.radius()), d2 = length_squared(b.box.centre() - receiver.p);
    gain[i] = nodes_[node].right && r2 > 0.02f * d2 ? out.importance[i] * std::min(r2 / std::max(d2, 1e-20f), 1.0f) : 0.0f;
  };
  place(0, 0);
  out.count = 1;
  while (out.count < kCutSize) {
    const int i = int(std::max_element(gain, gain + out.count) - gain);
    if (!(gain[i] > 0)) break;
    const uint32_t node = out.nodes[i];
    place(i, node + 1);
    place(out.count++, nodes_[node].right);
  }
  for (int i = 0; i < out.count; ++i) out.total += out.importance[i];
}

bool LightTree::sample(const Cut &cut, const Receiver &receiver, float u, uint32_t &light, float &probability) const {
  if (!(cut.total > 0)) return false;
  float x = u * cut.total;
  int first = 0;
  while (first + 1 < cut.count && x >= cut.importance[first]) x -= cut.importance[first++];
  if (!(cut.importance[first] > 0)) return false;
  uint32_t node = cut.nodes[first];
  probability = cut.importance[first] / cut.total;
  u = clamp(x / cut.importance[first], 0.0f, 0x1.fffffep-1f);
  while (nodes_[node].right) {
    const uint32_t left = node + 1, right = nodes_[node].right;
    const float a = importance(nodes_[left].bounds, receiver), b = importance(nodes_[right].bounds, receiver);
    if (!(a + b > 0)) return false;
    const float p = a / (a + b);
    if (u < p) node = left, probability *= p, u = reuse_below(u, p);
    else node = right, probability *= 1 - p, u = reuse_above(u, p);
  }
  light = nodes_[node].light;
  return probability > 0;
}

float LightTree::probability(const Cut &cut, const Receiver &receiver, uint32_t light) const {
  if (light >= leaf_of_.size() || !(cut.total > 0)) return 0;
  float probability = 1;
  for (uint32_t node = leaf_of_[light];; node = nodes_[node].parent) {
    for (int i = 0; i < cut.count; ++i)
      if (cut.nodes[i] == node) return probability * cut.importance[i] / cut.total;
    if (node == 0) return 0;
    const uint32_t parent = nodes_[node].parent, left = parent + 1, right = nodes_[parent].right;
    const float a = importance(nodes_[left].bounds, receiver), b = importance(nodes_[right].bounds, receiver);
    if (!(a + b > 0)) return 0;
    const float p = a / (a + b);
    probability *= node == left ? p : 1 - p;
  }
}

}  // namespace opal
