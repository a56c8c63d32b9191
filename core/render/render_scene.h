/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* render_scene.h: a film filled with a scene: the integrator of scene, geometry and lights given to render.h. */
#ifndef MU_RENDER_SCENE_H
#define MU_RENDER_SCENE_H

#include "core/render/geometry.h"
#include "core/render/light.h"
#include "core/render/render.h"

/* `limits`: threads, samples, seconds and noise of the plan; the rest of it is the scene's. */
mu_render_end mu_render_scene(mu_film *film, const mu_scene *scene, const mu_geometry *geometry,
                              const mu_lights *lights, const mu_render_plan *limits,
                              const mu_render_watch *watch, mu_error *error);

#endif
