// SPDX-License-Identifier: GPL-3.0-or-later
// Which instances may have faces in the same place as those of another, so that rays have to look (scene/contact.h).
#pragma once

#include "scene/scene.h"

namespace opal {

// Sets Instance::touching, Instance::order and Scene::any_touching.
void find_touching(Scene &scene);

}  // namespace opal
