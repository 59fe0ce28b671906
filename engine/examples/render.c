/* SPDX-License-Identifier: GPL-3.0-or-later
 * The C API on one page: a mirror sphere on a plate under a moon in haze, rendered to render.pfm.
 *     cc -std=c99 render.c -lglimmer -lm && ./a.out
 */
#include <glimmer.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 320, HEIGHT = 180 };

/* Every call that can fail says why in one line. */
static void check(glimmer_result result) {
    if (result == GLIMMER_OK)
        return;
    fprintf(stderr, "glimmer: %s\n", glimmer_last_error());
    exit(2);
}

/* A material whose one parameter is a colour. glimmer_parameter_info lists what types and parameters there are. */
static uint32_t add_material(glimmer_scene *scene, const char *type, const char *key, float r, float g, float b) {
    const glimmer_parameter parameter = {.key = key, .value = {r, g, b}};
    glimmer_material_desc desc;
    glimmer_material_init(&desc); /* sets struct_size and the defaults: never fill a struct without it */
    desc.type = type;
    desc.parameter_count = 1, desc.parameters = &parameter;
    uint32_t material;
    check(glimmer_scene_add_material(scene, &desc, &material));
    return material;
}

static void add_sphere(glimmer_scene *scene, double x, double y, double z, double radius, uint32_t material) {
    const double center[3] = {x, y, z};
    glimmer_spheres_desc desc;
    glimmer_spheres_init(&desc);
    desc.count = desc.radius_count = 1;
    desc.centers = center, desc.radii = &radius; /* copied before the call returns */
    desc.material = material;
    check(glimmer_scene_add_spheres(scene, &desc));
}

static void add_plate(glimmer_scene *scene, uint32_t material) {
    static const float vertices[4][3] = {{-30, -10, 0}, {30, -10, 0}, {30, 60, 0}, {-30, 60, 0}};
    static const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    glimmer_mesh_desc mesh_desc;
    glimmer_mesh_init(&mesh_desc);
    mesh_desc.vertex_count = 4, mesh_desc.vertices = vertices;
    mesh_desc.triangle_count = 2, mesh_desc.triangles = &triangles[0][0];
    glimmer_mesh *mesh;
    check(glimmer_mesh_create(&mesh_desc, &mesh));

    glimmer_object_desc desc;
    glimmer_object_init(&desc);
    desc.mesh = mesh;
    desc.material_count = 1, desc.materials = &material;
    check(glimmer_scene_add_object(scene, &desc));
    glimmer_mesh_destroy(mesh); /* the scene holds it from here on */
}

static void set_camera_and_film(glimmer_scene *scene) {
    /* From (0, -6, 2), level, along +y: the columns are right, up, backward and the position. */
    static const double to_world[16] = {1, 0, 0, 0, 0, 0, -1, -6, 0, 1, 0, 2, 0, 0, 0, 1};
    glimmer_camera_desc camera;
    glimmer_camera_init(&camera);
    for (int i = 0; i < 16; ++i)
        camera.to_world[i] = to_world[i];
    camera.fov_x = 60;
    check(glimmer_scene_set_camera(scene, &camera));
    glimmer_film_desc film;
    glimmer_film_init(&film);
    film.width = WIDTH, film.height = HEIGHT;
    check(glimmer_scene_set_film(scene, &film));
}

static void write_pfm(const char *name, const float *rgb) {
    FILE *file = fopen(name, "wb");
    int ok = file != NULL && fprintf(file, "PF\n%d %d\n-1.0\n", WIDTH, HEIGHT) > 0;
    for (int y = HEIGHT; ok && y-- > 0;) /* rows from the bottom up */
        ok = fwrite(rgb + 3 * WIDTH * y, sizeof(float), 3 * WIDTH, file) == 3 * WIDTH;
    if (file == NULL || fclose(file) != 0 || !ok) {
        fprintf(stderr, "%s: cannot be written\n", name);
        exit(2);
    }
}

int main(void) {
    if (glimmer_abi_version() != GLIMMER_ABI_VERSION) {
        fprintf(stderr, "glimmer.h and the library are of different versions\n");
        return 2;
    }
    glimmer_scene *scene;
    check(glimmer_scene_create(&scene));
    add_plate(scene, add_material(scene, "lambert", "albedo", 0.6f, 0.6f, 0.65f));
    add_sphere(scene, -1.2, 1, 1, 1, add_material(scene, "mirror", "reflectance", 0.95f, 0.95f, 0.95f));
    add_sphere(scene, 3, 6, 4, 1.2, add_material(scene, "light", "radiance", 20, 14, 8));
    const double sigma_a[3] = {0.002, 0.002, 0.002}, sigma_s[3] = {0.02, 0.022, 0.026};
    check(glimmer_scene_set_medium(scene, sigma_a, sigma_s, 0));
    set_camera_and_film(scene);
    check(glimmer_scene_commit(scene, 0)); /* from here on it never changes, and many renders may share it */

    glimmer_render_desc desc;
    glimmer_render_init(&desc);
    desc.samples = 16;
    glimmer_render *render;
    check(glimmer_render_create(scene, &desc, &render));
    glimmer_scene_destroy(scene); /* the render holds it */
    check(glimmer_render_start(render));
    glimmer_progress progress;
    do { /* the pixels may be read at any time, too */
        check(glimmer_render_wait(render, 0.25));
        glimmer_progress_init(&progress);
        check(glimmer_render_poll(render, &progress));
        fprintf(stderr, "%3.0f %%, %llu samples a pixel\n", 100 * progress.fraction,
                (unsigned long long)progress.samples);
    } while (progress.state == GLIMMER_RUNNING);

    static float rgb[3 * WIDTH * HEIGHT];
    check(glimmer_render_read(render, GLIMMER_PASS_COMBINED, 0, 0, WIDTH, HEIGHT, rgb, 3 * WIDTH * HEIGHT));
    glimmer_render_destroy(render);
    write_pfm("render.pfm", rgb);
    if (!isnan(progress.relmse))
        printf("render.pfm: relMSE %.3g, between %.3g and %.3g\n", progress.relmse, progress.relmse_low,
               progress.relmse_high);
    return 0;
}
