// SPDX-License-Identifier: GPL-3.0-or-later
// Which gems a path is inside of, and what a boundary therefore separates.
//
// Interiors may overlap and touch: at every point the one of highest priority counts (Schmidt & Budge 2002, "Simple Nested
// Dielectrics in Ray Traced Images"), among equals the smaller body, so that what lies within another body is in it without
// being told. Which one counts does not depend on the path that led there, or light could get lost between them. A boundary
// between two points that belong to the same interior is no boundary, and the path goes straight on.
#pragma once

#include "scene/scene.h"

namespace opal {

class InteriorStack {
 public:
  static constexpr int kCapacity = 32;

  struct Entry {
    uint32_t instance = 0, material = 0;
    int32_t priority = 0;
    uint32_t order = 0;  // among equal priorities, Instance::order

    bool fills_before(const Entry &other) const {
      return priority != other.priority ? priority > other.priority : order >= other.order;
    }
  };

  bool empty() const { return count_ == 0; }
  int count() const { return count_; }
  // How often a body was entered within as many as are kept account of: it was passed over.
  int passed_over() const { return passed_over_; }

  // The interior that counts, or nullptr outside of everything.
  const Entry *current() const { return best(-1); }
  // The one that would count without the entry of `instance` and `material` (the latest such entry).
  const Entry *without(uint32_t instance, uint32_t material) const { return best(find(instance, material)); }
  bool contains(uint32_t instance, uint32_t material) const { return find(instance, material) >= 0; }
  bool contains(uint32_t instance) const {
    for (int i = 0; i < count_; ++i)
      if (entries_[i].instance == instance) return true;
    return false;
  }

  void enter(const Entry &entry) {
    if (count_ < kCapacity) entries_[count_++] = entry;
    else ++passed_over_;
  }
  void leave(uint32_t instance, uint32_t material) {
    const int i = find(instance, material);
    if (i < 0) return;
    for (int k = i; k + 1 < count_; ++k) entries_[k] = entries_[k + 1];
    --count_;
  }
  void clear() { count_ = 0; }

 private:
  int find(uint32_t instance, uint32_t material) const {
    for (int i = count_ - 1; i >= 0; --i)
      if (entries_[i].instance == instance && entries_[i].material == material) return i;
    return -1;
  }
  const Entry *best(int ignored) const {
    const Entry *found = nullptr;
    for (int i = 0; i < count_; ++i)
      if (i != ignored && (!found || entries_[i].fills_before(*found))) found = &entries_[i];
    return found;
  }

  Entry entries_[kCapacity];
  int count_ = 0, passed_over_ = 0;
};

inline Spectrum lookup(const SpectralTable &table, const Wavelengths &w) {
  Spectrum s;
  for (int i = 0; i < kWavelengths; ++i) s[i] = lookup(table, w.nm[i]);
  return s;
}

inline Spectrum index_of_refraction(const Scene &scene, const InteriorStack::Entry *entry, const Wavelengths &w) {
  if (!entry) return Spectrum(1.0f);
  return lookup(scene.spectra[size_t(scene.materials[entry->material].gem.index_spectrum)], w);
}

// The table of what the interior that counts absorbs, 1/m; -1: none.
inline int32_t absorption_table(const Scene &scene, const InteriorStack &interior) {
  const InteriorStack::Entry *entry = interior.current();
  return entry ? scene.materials[entry->material].gem.absorption_spectrum : -1;
}
// Beer-Lambert over `distance` metres of it.
inline void absorb(const Scene &scene, const InteriorStack &interior, float distance, const Wavelengths &w,
                   Spectrum &throughput) {
  const int32_t table = absorption_table(scene, interior);
  if (table < 0) return;
  const Spectrum sigma = lookup(scene.spectra[size_t(table)], w);
  for (int i = 0; i < kWavelengths; ++i) throughput[i] *= std::exp(-sigma[i] * distance);
}

// What the boundary hit at `sp` separates. False: nothing, because both sides belong to the same interior; then
// `entering` still says how to update the stack.
struct Boundary {
  bool real = false, entering = false;
  InteriorStack::Entry entry;
  Spectrum n_front, n_behind;
};
inline Boundary boundary_at(const Scene &scene, const InteriorStack &interior, const ShadingPoint &sp, uint32_t material,
                            const Wavelengths &w) {
  Boundary b;
  b.entry = {sp.instance_index, material, scene.materials[material].gem.priority, sp.instance->order};
  b.entering = !sp.backfacing;
  if (b.entering) {
    const InteriorStack::Entry *front = interior.current();
    b.real = !front || b.entry.fills_before(*front);
    b.n_front = index_of_refraction(scene, front, w);
    b.n_behind = index_of_refraction(scene, b.real ? &b.entry : front, w);
  } else {
    const InteriorStack::Entry *front = interior.current();
    // A path that meets an inner side without having entered (an open mesh, a camera inside): taken as inside.
    const bool known = interior.contains(b.entry.instance, b.entry.material);
    const bool is_current = !known || (front->instance == b.entry.instance && front->material == b.entry.material);
    b.real = is_current;
    b.n_front = index_of_refraction(scene, known ? front : &b.entry, w);
    b.n_behind = index_of_refraction(scene, known ? interior.without(b.entry.instance, b.entry.material) : front, w);
  }
  return b;
}
inline void cross_boundary(const Boundary &b, InteriorStack &interior) {
  if (b.entering) interior.enter(b.entry);
  else interior.leave(b.entry.instance, b.entry.material);
}

// What a path that starts at p is inside of: a camera or a lamp within a gem.
InteriorStack interior_at(const Scene &scene, const Vec3 &p);

}  // namespace opal
