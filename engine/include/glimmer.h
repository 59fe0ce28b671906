/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Glimmer: a path tracer for hazy, moonlit worlds of metal. The C API of the engine, C99.
 *
 * Order of calls: create meshes and images, create a scene, add to it, commit it, create a render, start it,
 * read it while it runs or after it, destroy everything (in any order: every object counts its references).
 * A committed scene never changes; meshes and images may be shared by any number of scenes.
 *
 * Results: every call that can fail returns a glimmer_result; glimmer_last_error() then holds one line that says
 *     what is wrong, where, and what is allowed. Nothing is written to the outputs of a call that failed.
 * Floating point: the calling thread's mode (rounding, denormals, traps) makes no difference and is left as it was.
 * Memory: what is handed in is copied before the call returns. Strings are UTF-8 and end in 0.
 * Structs: every description starts with struct_size, set by the caller to sizeof(the struct); fill it from
 *     glimmer_*_init(), which also sets the defaults, so that a newer library understands an older caller.
 * Threads: calls on different objects may run at the same time. Calls on one mesh, image or scene must not overlap,
 * except that a committed scene may be used by many renders. Every call on a render may be made from any thread. Units:
 * one length unit throughout; angles in degrees; colours linear RGB (Rec. 709 primaries); radiance in W/(m^2 sr),
 *     intensity in W/sr, irradiance in W/m^2; sigma in inverse lengths. Matrices are row-major with column vectors.
 * Directions: right-handed world. A camera looks along its -z with y up, x to the right.
 */
#ifndef GLIMMER_H
#define GLIMMER_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define GLIMMER_API __declspec(dllexport)
#else
#define GLIMMER_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Changes whenever a caller compiled against an older header would break. Compare with glimmer_abi_version(). */
#define GLIMMER_ABI_VERSION 2

typedef enum glimmer_result {
    GLIMMER_OK = 0,
    GLIMMER_INVALID_ARGUMENT = 1, /* a value is out of its range, or a handle is null or of another kind */
    GLIMMER_INVALID_STATE =
        2, /* a call in the wrong order: to change or commit a committed scene, to commit one without
              camera or film, to render one that is not committed; to start a render twice, to wait
              for one that was not started, to save one that runs, to load into one that started */
    GLIMMER_OUT_OF_MEMORY = 3,
    GLIMMER_UNAVAILABLE = 4, /* from commit: this processor lacks what the engine was built for */
    GLIMMER_INTERNAL = 5     /* a defect of the engine; please report it */
} glimmer_result;

typedef struct glimmer_mesh glimmer_mesh;
typedef struct glimmer_image glimmer_image;
typedef struct glimmer_texture glimmer_texture;
typedef struct glimmer_scene glimmer_scene;
typedef struct glimmer_render glimmer_render;

GLIMMER_API uint32_t glimmer_abi_version(void);
/* "MAJOR.MINOR.PATCH" */
GLIMMER_API const char *glimmer_version(void);
/* For people: the compiler, Embree, and which of its instruction sets the library uses on this processor. */
GLIMMER_API const char *glimmer_build_info(void);
/* The message of the last call on this thread that failed; "" if none did. Valid until this thread's next call. */
GLIMMER_API const char *glimmer_last_error(void);

/* Array elements handed in as either precision. Positions far from the origin need float64. */
typedef enum glimmer_format { GLIMMER_FLOAT32 = 0, GLIMMER_FLOAT64 = 1 } glimmer_format;

/* ---- Meshes --------------------------------------------------------------------------------------------------- */

typedef enum glimmer_attribute_domain {
    GLIMMER_PER_VERTEX = 0,
    GLIMMER_PER_CORNER = 1, /* three rows a triangle, in their order */
    GLIMMER_PER_TRIANGLE = 2,
    GLIMMER_PER_INSTANCE = 3 /* of an object, not of a mesh */
} glimmer_attribute_domain;

typedef struct glimmer_attribute {
    const char *name;
    glimmer_attribute_domain domain;
    uint32_t components; /* 1 to 4 */
    const float *values; /* (count of the domain, components), finite */
} glimmer_attribute;

typedef struct glimmer_mesh_desc {
    size_t struct_size;
    const char *name;          /* for messages; may be null */
    glimmer_format format;     /* of vertices, normals and uvs */
    size_t vertex_count;       /* >= 3 */
    const void *vertices;      /* (vertex_count, 3), finite */
    const void *normals;       /* (vertex_count, 3) or null for flat shading; a zero normal means the face's own */
    const void *uvs;           /* (vertex_count, 2) or null */
    size_t triangle_count;     /* >= 1 */
    const uint32_t *triangles; /* (triangle_count, 3), each below vertex_count */
    const uint16_t *slots;     /* (triangle_count): which of the object's materials; null: all use the first */
    size_t attribute_count;    /* up to 256 */
    const struct glimmer_attribute *attributes; /* for shader programs, each of a name of its own */
} glimmer_mesh_desc;

GLIMMER_API void glimmer_mesh_init(glimmer_mesh_desc *desc);
/* Degenerate triangles are allowed: no ray meets them. */
GLIMMER_API glimmer_result glimmer_mesh_create(const glimmer_mesh_desc *desc, glimmer_mesh **mesh);
GLIMMER_API void glimmer_mesh_destroy(glimmer_mesh *mesh); /* null is allowed, here and in every destroy */

/* ---- Images --------------------------------------------------------------------------------------------------- */

/* pixels: (height, width, channels) linear, top row first, finite, >= 0. channels: 3 or 4 (the fourth is ignored). */
GLIMMER_API glimmer_result glimmer_image_create(uint32_t width, uint32_t height, uint32_t channels, const float *pixels,
                                                glimmer_image **image);
GLIMMER_API void glimmer_image_destroy(glimmer_image *image);

/* ---- Textures ------------------------------------------------------------------------------------------------- */

typedef enum glimmer_texel_format { GLIMMER_TEXEL_UINT8 = 0, GLIMMER_TEXEL_FLOAT32 = 1 } glimmer_texel_format;

/* An image that shader programs look up. It is kept as it is handed in. */
typedef struct glimmer_texture_desc {
    size_t struct_size;
    const char *name;                 /* for messages; may be null */
    uint32_t width, height, channels; /* 1 to 65536, 1 to 65536, 1 to 4: grey; grey, alpha; colour; colour, alpha */
    glimmer_texel_format format;
    int srgb;           /* colours are encoded as sRGB: decoded after filtering */
    const void *pixels; /* (height, width, channels), bottom row first, finite; colours multiplied by their alpha */
} glimmer_texture_desc;

GLIMMER_API void glimmer_texture_init(glimmer_texture_desc *desc);
GLIMMER_API glimmer_result glimmer_texture_create(const glimmer_texture_desc *desc, glimmer_texture **texture);
GLIMMER_API void glimmer_texture_destroy(glimmer_texture *texture);

/* ---- Shader programs ------------------------------------------------------------------------------------------ */

/* An operation: its number is its place in the table. */
typedef struct glimmer_op_info_t {
    const char *name;
    const char *modes;  /* fields parted by '|', the words of each by ' '; "" for none */
    const char *inputs; /* a letter each: n a number, v a vector or colour */
    char output;        /* n or v */
    char resource;      /* what glimmer_instruction.resource counts: t tables, i textures, a attributes, - nothing */
} glimmer_op_info_t;
/* Null when index is out of range. */
GLIMMER_API const glimmer_op_info_t *glimmer_op_info(uint32_t index);

#define GLIMMER_CONSTANT 0x8000u /* added to the number of a constant where an input may be a register */

typedef struct glimmer_instruction {
    uint16_t op;
    uint16_t out;    /* register, 0 to 255 */
    uint8_t mode[6]; /* the number of a word of each of the op's fields; 0 where it has none */
    uint16_t resource;
    uint16_t in[10]; /* registers that an instruction before has written, or GLIMMER_CONSTANT + constant */
} glimmer_instruction;

typedef struct glimmer_table {
    size_t row_count;  /* 2 to 65536 */
    const float *rows; /* (row_count, 4), finite, at equal steps from low to high */
    float low, high;
} glimmer_table;

/* Straight-line code that gives what varies over a surface or a sky. */
typedef struct glimmer_program_desc {
    size_t struct_size;
    const char *name;         /* for messages; may be null */
    size_t instruction_count; /* up to 4096 */
    const glimmer_instruction *instructions;
    size_t constant_count;  /* up to 8192 */
    const float *constants; /* (constant_count, 3), finite; of a number the first */
    size_t table_count;     /* up to 256 */
    const glimmer_table *tables;
    size_t texture_count; /* up to 256 */
    glimmer_texture *const *textures;
    size_t attribute_count;        /* up to 256 */
    const char *const *attributes; /* names of the meshes' attributes; where a mesh has none of a name it is 0 */
    size_t output_count;           /* 1 to 64 */
    const uint16_t *outputs;       /* registers */
} glimmer_program_desc;

/* ---- Scene ---------------------------------------------------------------------------------------------------- */

GLIMMER_API glimmer_result glimmer_scene_create(glimmer_scene **scene);
GLIMMER_API void glimmer_scene_destroy(glimmer_scene *scene);

/* A material is a type and values for its parameters, all by name. One table in the engine says what there is: the C
 * API checks by it, and scene files and the add-on are read and written by it. */
typedef enum glimmer_parameter_kind {
    GLIMMER_NUMBER = 0,
    GLIMMER_COLOR = 1,   /* 3 numbers */
    GLIMMER_WORD = 2,    /* one of a few words */
    GLIMMER_MATERIAL = 3 /* another material of the scene, added before */
} glimmer_parameter_kind;

typedef struct glimmer_material_info_t {
    const char *type; /* "lambert", "mirror", ... as in a scene file */
    int mixable;      /* not 0: may be a parameter of another material */
    const char *help; /* one line */
} glimmer_material_info_t;
/* Null when index is out of range. */
GLIMMER_API const glimmer_material_info_t *glimmer_material_info(uint32_t index);

typedef struct glimmer_parameter_info_t {
    const char *type; /* of the material that has it */
    const char *key;
    glimmer_parameter_kind kind;
    int required;         /* not 0: must be given */
    uint32_t alternative; /* 0, or the number of the alternative that it belongs to: the parameters of exactly one may
                             be given, with all of that one which are required */
    double low, high;     /* what each number may be; high may be infinite, the number itself not */
    int above_low;        /* not 0: low itself is not allowed */
    float value;          /* number, colour: what it is when it is not given (of a colour in all channels) */
    const char *words;    /* of a word, parted by spaces; the first is the default */
    const char *noun;     /* what a word of it is called: "masking function" */
    const char *help;     /* one line */
} glimmer_parameter_info_t;
/* Null when index is out of range; the parameters of a type stand together. */
GLIMMER_API const glimmer_parameter_info_t *glimmer_parameter_info(uint32_t index);

typedef struct glimmer_parameter {
    const char *key;
    float value[3]; /* of a number the first */
    const char *word;
    uint32_t material;
} glimmer_parameter;

typedef struct glimmer_material_desc {
    size_t struct_size;
    const char *name; /* for messages and the report; may be null */
    const char *type;
    size_t parameter_count; /* up to 64, each of another key */
    const glimmer_parameter *parameters;
} glimmer_material_desc;

GLIMMER_API void glimmer_material_init(glimmer_material_desc *desc);
GLIMMER_API glimmer_result glimmer_scene_add_material(glimmer_scene *scene, const glimmer_material_desc *desc,
                                                      uint32_t *material);

GLIMMER_API void glimmer_program_init(glimmer_program_desc *desc);
GLIMMER_API glimmer_result glimmer_scene_add_program(glimmer_scene *scene, const glimmer_program_desc *desc,
                                                     uint32_t *program);
/* From now on a parameter of a material is an output of a program, cut to the parameter's range wherever it is
   evaluated; the value that it was added with no longer counts. key: of a number or colour of the material's type (see
   glimmer_parameter_info), or the shading normal in the world: "normal", or where a bump turns it "bumped_normal" or
   "bumped_normal_cubic", which take diffuse light near the terminator of the smooth surface, by the masking of facets
   as steep or by a cubic. Not for glass. Or, of all, "aov_1", "aov_2", ...: a number, colour or vector that
   GLIMMER_PASS_AOV and those behind it show as it is; of parts of mixes it is not asked. */
GLIMMER_API glimmer_result glimmer_scene_bind(glimmer_scene *scene, uint32_t material, const char *key,
                                              uint32_t program, uint32_t output);
/* The environment's radiance is an output of a program, in place of glimmer_scene_set_environment. It is asked for
   positions: directions of unit length into the sky. */
GLIMMER_API glimmer_result glimmer_scene_bind_environment(glimmer_scene *scene, uint32_t program, uint32_t output);
/* What light `light` of the scene, the first added is 0, shines is multiplied by an output of a program, cut to 0 and
   more. It is asked for positions on the light; its normal there, which is the direction to what it lights unless the
   light has a shape of its own; "incoming", that direction; and as the object's space for to_world (row-major, affine).
   It is met by no kind of ray. A program that asks for ray_length keeps light from being traced from the lamps: what
   scatters often then takes longer. */
GLIMMER_API glimmer_result glimmer_scene_bind_light(glimmer_scene *scene, uint32_t light, uint32_t program,
                                                    uint32_t output, const double to_world[16]);
/* The bound environment has a sun, which its program shows where geometry_number's sun_disc is 1. The camera sees it in
   the sky; its light is that of a lamp, of the mean of the disc. direction: of the light's travel, not 0; angle: full,
   in degrees, above 0 and up to 180. */
GLIMMER_API glimmer_result glimmer_scene_bind_sun(glimmer_scene *scene, const double direction[3], double angle);

/* What rays are for, as a set of bits: objects, lights and the environment may be hidden from some. A ray that goes
 * straight through a surface keeps its kind. */
typedef enum glimmer_ray {
    GLIMMER_RAY_CAMERA = 1,       /* the camera's own */
    GLIMMER_RAY_DIFFUSE = 2,      /* reflected by a diffuse lobe */
    GLIMMER_RAY_GLOSSY = 4,       /* reflected by any other */
    GLIMMER_RAY_TRANSMISSION = 8, /* on the other side of the surface that they come from */
    GLIMMER_RAY_VOLUME = 16,      /* scattered by the medium; they meet what diffuse rays meet as well */
    GLIMMER_RAY_SHADOW = 32,      /* between a point and a light that lights it */
    GLIMMER_RAY_ALL = 63
} glimmer_ray;

/* A coefficient of a medium that an output of a program gives, in place of the value in the description. The program is
 * evaluated at points within the surface: positions, object_position, object_location, the camera's coordinates and
 * attributes of instances are known there; what is asked about a surface is 0. What is below 0 is cut. */
typedef struct glimmer_medium_binding {
    const char *key; /* sigma_a, sigma_s or emission: a vector; g: a number */
    uint32_t program, output;
} glimmer_medium_binding;

/* What a closed surface is filled with. Per channel and length; g: Henyey-Greenstein, -1 < g < 1. */
typedef struct glimmer_medium_desc {
    size_t struct_size;
    double sigma_a[3], sigma_s[3]; /* absorption and scattering, >= 0 */
    double g;
    double emission[3];                     /* radiance that a length adds, >= 0 */
    size_t binding_count;                   /* up to 4, each of another key; default 0: homogeneous */
    const glimmer_medium_binding *bindings; /* (binding_count) */
} glimmer_medium_desc;

GLIMMER_API void glimmer_medium_init(glimmer_medium_desc *desc);

typedef struct glimmer_object_desc {
    size_t struct_size;
    const char *name; /* for messages; may be null */
    glimmer_mesh *mesh;
    size_t material_count;     /* >= 1 and above every slot of the mesh */
    const uint32_t *materials; /* (material_count) */
    double to_world[16];       /* affine; applied after the instance's own matrix; default identity */
    size_t instance_count;     /* used when instances is not null */
    glimmer_format instance_format;
    const void *instances;          /* (instance_count, 3, 4), or null for a single one at to_world */
    uint32_t object_index;          /* what the object index AOV shows */
    const uint32_t *object_indices; /* (instance_count) of them, or null */
    float color[4];                 /* what shader programs know as the object's colour and alpha; default 1 1 1 1 */
    float random;                   /* what they know as its own number, 0 to 1 */
    const float *randoms;           /* (instance_count) of them, or null */
    /* Motion while the shutter is open: (motion_count, 4, 4) matrices in place of to_world, at moments evenly spaced
     * from when it opens to when it closes; between them they are interpolated. null (the default): still. What shines
     * is held still, with a warning. */
    const double *motion;
    size_t motion_count; /* 2 to 1024, used when motion is not null */
    uint32_t visible;    /* set of glimmer_ray that meet it; default all */
    int holdout;         /* not 0: a hole where the camera sees it, also through what is transparent: black, whatever is
                            behind it. Other rays meet it as it is */
    size_t attribute_count;                     /* up to 256 */
    const struct glimmer_attribute *attributes; /* per instance: what programs find in place of the mesh's own */
    const glimmer_medium_desc *interior;        /* what the mesh, which should be closed, is filled with, whatever its
                                                   materials; null for nothing. Where several are, they add up. */
    uint32_t matte;          /* what the object matte pass shows, up to 2^24; 0, the default, is shown as nothing */
    uint32_t light_group;    /* of what shines of it, 1 to GLIMMER_MAX_LIGHT_GROUPS; 0, the default: none */
    float shadow_terminator; /* 0 (default) to 1: cosine to the surface below which lamps see a smooth mesh as the
                                curved surface that its normals stand for, not as triangles */
} glimmer_object_desc;

GLIMMER_API void glimmer_object_init(glimmer_object_desc *desc);
GLIMMER_API glimmer_result glimmer_scene_add_object(glimmer_scene *scene, const glimmer_object_desc *desc);

typedef struct glimmer_spheres_desc {
    size_t struct_size;
    const char *name;
    size_t count;
    const double *centers; /* (count, 3) */
    size_t radius_count;   /* 1 or count */
    const double *radii;   /* > 0 */
    uint32_t material;
    uint32_t object_index;
    uint32_t visible; /* as of objects */
    int holdout;
    const glimmer_medium_desc *interior; /* as of an object */
    uint32_t matte, light_group;         /* as of an object */
} glimmer_spheres_desc;

GLIMMER_API void glimmer_spheres_init(glimmer_spheres_desc *desc);
GLIMMER_API glimmer_result glimmer_scene_add_spheres(glimmer_scene *scene, const glimmer_spheres_desc *desc);

/* Lamps, as Blender has them: they shine, cast no shadow and hide nothing, and without further ado the camera does not
 * see them. */
typedef enum glimmer_light_type {
    GLIMMER_POINT =
        0, /* position, color = intensity, radius (0: a point; else a sphere of radiance intensity/(pi r^2)) */
    GLIMMER_SPOT = 1, /* the same, with direction, angle (full cone, 0 to 180) and blend (0 to 1, of the cone) */
    GLIMMER_SUN =
        2, /* direction the light travels in, color = irradiance at normal incidence, angle (full, 0 to 180) */
    GLIMMER_AREA = 3 /* to_world (rigid), size, ellipse; color = radiance; emits along its -z */
} glimmer_light_type;

typedef struct glimmer_light_desc {
    size_t struct_size;
    const char *name;
    glimmer_light_type type;
    float color[3];
    double position[3];
    double direction[3]; /* need not be normalised; not zero */
    double radius;       /* >= 0 */
    double angle, blend;
    double to_world[16];
    double size[2]; /* > 0 */
    int ellipse;
    uint32_t visible;     /* set of glimmer_ray that meet it, and of the lobes that it lights; shadow rays always do.
                             Default: all but the camera's. A point and a sun of no angle are met by none */
    int shadows;          /* default 1; 0: nothing stands between it and what it lights */
    uint32_t max_bounces; /* it lights what has at most so many scattering vertices between itself and the camera;
                             default UINT32_MAX, no limit */
    int disk; /* point and spot: not 0: with a radius, a disk that faces the point it lights, of the same radiance. Sun:
                 not 0: its radiance grows as 1/cos^3 of the angle to its middle, color / (pi tan^2 (angle/2)) there */
    int times_cosine; /* spot: not 0: it is darker by the cosine to its axis too */
    double spread;    /* area: full angle about its normal to which it shines, dimmed as by slats, with the same power;
                         above    0 to 180, the default */
    uint32_t light_group; /* as of an object */
} glimmer_light_desc;

GLIMMER_API void glimmer_light_init(glimmer_light_desc *desc);
GLIMMER_API glimmer_result glimmer_scene_add_light(glimmer_scene *scene, const glimmer_light_desc *desc);

/* Radiance from outside the scene: color, times image (equirectangular, centre along +y, z up) where it is not null. */
GLIMMER_API glimmer_result glimmer_scene_set_environment(glimmer_scene *scene, const float color[3],
                                                         glimmer_image *image, const double to_world[16]);

/* Which rays see the environment, a set of glimmer_ray; all, if this is never called. */
GLIMMER_API glimmer_result glimmer_scene_set_environment_visible(glimmer_scene *scene, uint32_t visible);

/* As of an object. */
GLIMMER_API glimmer_result glimmer_scene_set_environment_light_group(glimmer_scene *scene, uint32_t light_group);

/* Homogeneous, fills all space outside bodies of glass. sigma >= 0 per channel; g: Henyey-Greenstein, -1 < g < 1. */
GLIMMER_API glimmer_result glimmer_scene_set_medium(glimmer_scene *scene, const double sigma_a[3],
                                                    const double sigma_s[3], double g);

/* From now on the medium that fills all space thins out with height, along +z: it is as glimmer_scene_set_medium says
 * at z = height, times exp(-(z - height) / scale_height) elsewhere. scale_height > 0. Lights infinitely far away shine
 * through it. Not together with media within surfaces. */
GLIMMER_API glimmer_result glimmer_scene_set_medium_falloff(glimmer_scene *scene, double height, double scale_height);

/* From 2 on panoramas, which Blender's users know from Cycles. r: distance from the picture's middle in widths of the
 * whole panorama, theta: angle to the axis. Clipping planes and what is in focus are spheres about the camera then. */
typedef enum glimmer_camera_type {
    GLIMMER_PERSPECTIVE = 0,
    GLIMMER_ORTHOGRAPHIC = 1,
    GLIMMER_EQUIRECTANGULAR = 2,     /* longitude across, latitude up */
    GLIMMER_FISHEYE_EQUIDISTANT = 3, /* theta grows evenly from the middle to an ellipse that touches all four edges */
    GLIMMER_FISHEYE_EQUISOLID = 4,   /* r = 2 focal_length sin(theta / 2) */
    GLIMMER_FISHEYE_POLYNOMIAL = 5,  /* theta = a polynomial of r */
    GLIMMER_MIRROR_BALL = 6,         /* what a ball of mirror shows from far away; an ellipse as above */
    GLIMMER_CUBE_FACE = 7,           /* 90 degrees across and up, by equal angles */
    GLIMMER_CYLINDRICAL = 8          /* longitude across, tangent of the latitude up */
} glimmer_camera_type;

typedef struct glimmer_camera_desc {
    size_t struct_size;
    double to_world[16]; /* rotation or reflection, and translation; looks along -z, y up; default identity */
    double fov_x;    /* perspective: full horizontal angle of the whole width, also in portrait; above 0, below 180 */
    double shift[2]; /* of the picture on the film plane, in widths; positive x: the view moves right, y: up */
    double lens_radius, focus_distance; /* 0: no depth of field; the distance is along the axis */
    double clip_start, clip_end;        /* along the axis; default 0 and infinity. The start: 0 or more, of an
                                           orthographic camera any finite number, below 0 behind the camera */
    glimmer_camera_type type;           /* default perspective */
    double width;                       /* orthographic: length that the whole width shows, above 0; default 1 */
    /* Motion while the shutter is open: (motion_count, 4, 4) matrices in place of to_world, at moments evenly spaced
     * from when it opens to when it closes. In between, places and axes are interpolated, and the axes made orthonormal
     * again; neighbours turn by less than a right angle. null (the default): still. */
    const double *motion;
    size_t motion_count; /* 2 to 1024, used when motion is not null */
    /* Panoramas. The part of the whole that the picture shows: x0, y0, x1, y1, x right, y down, all of it 0 to 1 (the
     * default); x0 < x1, y0 < y1; -1000 to 1000 */
    double window[4];
    double longitude[2];  /* degrees, at the left and right edge; positive is right; default -180, 180; they differ */
    double latitude[2];   /* degrees, at the bottom and top edge; -90 to 90; they differ */
    double elevation[2];  /* cylindrical: tangent of the latitude, at the bottom and top edge; default -1, 1 */
    double fisheye_fov;   /* degrees; nothing is seen outside this cone; above 0, 3600 at most; default 180 */
    double focal_length;  /* equisolid: in widths of the whole panorama; above 0; default 0.29 */
    double polynomial[5]; /* coefficients of r^0 to r^4, radians; default theta = pi r */
    /* Spherical stereo, one eye of two whose head turns to every direction, about z, in a panorama about the camera's y
     * axis; not of orthographic cameras. Rays start `stereo_offset` to the right (below 0: left; 0, the default: no
     * stereo), and meet those of the other eye at the distance `stereo_convergence` (above 0; infinity, the default:
     * nowhere). From stereo_merge[0] to [1] degrees above and below the horizon the offset falls to 0; default 180,
     * 180: nowhere. */
    double stereo_offset, stereo_convergence, stereo_merge[2];
    /* The aperture: from 3 blades on (1024 at most) a regular polygon in the circle of the lens, the middle of an edge
     * turned by `aperture_rotation` degrees from x (right; y is up) counterclockwise; default 0, round. After that its
     * extent along x is divided by `aperture_ratio`, 1e-3 to 1e3, default 1. */
    uint32_t aperture_blades;
    double aperture_rotation, aperture_ratio;
} glimmer_camera_desc;

GLIMMER_API void glimmer_camera_init(glimmer_camera_desc *desc);
GLIMMER_API glimmer_result glimmer_scene_set_camera(glimmer_scene *scene, const glimmer_camera_desc *desc);

typedef enum glimmer_filter { GLIMMER_BOX = 0, GLIMMER_BLACKMAN_HARRIS = 1 } glimmer_filter;

typedef struct glimmer_film_desc {
    size_t struct_size;
    uint32_t width, height; /* 1 to 65536 */
    uint32_t crop[4];       /* x0, y0, x1, y1: what is rendered; all 0 (the default) for the whole picture */
    glimmer_filter filter;
    float filter_width; /* full, in pixels; box is exactly one pixel */
    float exposure;     /* factor of all light in the picture, >= 0; default 1 */
    int transparent; /* not 0: where the camera sees the environment, the picture is empty: alpha 0, and R G B are what
                        stands before it (premultiplied). Renders then have the alpha pass, asked for or not */
    float transparent_glass; /* of a transparent film: glass up to this GGX width, 0 to 1, is empty where the
                                environment is seen through it; below 0 (the default): none is */
    /* The mist pass: from 0 at `mist_start` from the camera to 1 `mist_depth` behind that, by the exponent
     * `mist_falloff`. Defaults 5, 25, 2. */
    float mist_start, mist_depth, mist_falloff;
    float occlusion_distance; /* of the ambient occlusion pass, >= 0; default 10 */
    float pixel_aspect;       /* width / height of a pixel, 0.001 to 1000; default 1 */
} glimmer_film_desc;

GLIMMER_API void glimmer_film_init(glimmer_film_desc *desc);
GLIMMER_API glimmer_result glimmer_scene_set_film(glimmer_scene *scene, const glimmer_film_desc *desc);

/* Checks the whole, builds what rays need, and freezes the scene. A camera and a film must have been set. A failed
 * commit leaves the scene as it was. threads: 0 (all) to 4096, the most that build; with another number than the last
 * commit's, meshes are built again, and while scenes of a larger number live, that one holds. */
GLIMMER_API glimmer_result glimmer_scene_commit(glimmer_scene *scene, uint32_t threads);
/* Like glimmer_render_report: warnings of a committed scene, one a line ("" if none). */
GLIMMER_API const char *glimmer_scene_warnings(glimmer_scene *scene);

/* What a warning is about, for programs: the words may change. Numbers and names are never reused. */
typedef enum glimmer_warning_code {
    GLIMMER_WARNING_RENAMED_INTEGRATOR = 0, /* a former name was given (of a render, not of a scene) */
    GLIMMER_WARNING_FLAT_INSTANCE = 1,      /* instances of zero scale are left out */
    GLIMMER_WARNING_FOLDING_MOTION = 2,     /* instances that turn too far between two steps are held still */
    GLIMMER_WARNING_SHINING_MOTION = 3,     /* instances that shine and move are held still */
    GLIMMER_WARNING_ENDLESS_FOG = 4,        /* lights at infinity are black behind the medium */
    GLIMMER_WARNING_NO_LIGHT = 5,           /* nothing shines */
    GLIMMER_WARNING_COUNT = 6
} glimmer_warning_code;
/* Its name, as in a report's "warning_codes"; null for a number that is none. */
GLIMMER_API const char *glimmer_warning_name(uint32_t code);
/* The code of a line of glimmer_scene_warnings, the first is 0; GLIMMER_WARNING_COUNT where there is none. */
GLIMMER_API glimmer_warning_code glimmer_scene_warning_code(glimmer_scene *scene, size_t line);

/* ---- Render --------------------------------------------------------------------------------------------------- */

/* The passes a render can give. One table in the engine drives them; see glimmer_pass_info. Pixels: y, x, channel, the
 * top row of the crop first. */
typedef enum glimmer_pass {
    GLIMMER_PASS_COMBINED = 0, /* RGB radiance */
    GLIMMER_PASS_STDERR = 1,   /* RGB standard error of the combined mean; NaN below 2 samples */
    GLIMMER_PASS_ALBEDO = 2,   /* RGB of the first non-specular surface */
    GLIMMER_PASS_NORMAL = 3,   /* XYZ world shading normal of the first surface */
    GLIMMER_PASS_DEPTH =
        4, /* Z: distance along the axis to the first surface, mean over the samples that hit; 1e10 if none */
    GLIMMER_PASS_EMISSION = 5,        /* RGB: light seen directly, also through mirrors and glass */
    GLIMMER_PASS_DIRECT = 6,          /* RGB: light scattered once, by a surface */
    GLIMMER_PASS_INDIRECT = 7,        /* RGB: light scattered more than once, first by a surface */
    GLIMMER_PASS_FOG = 8,             /* RGB: light that was last scattered by the fog before it came to the camera */
    GLIMMER_PASS_OBJECT_INDEX = 9,    /* X, of the first sample's first surface; 0 if none */
    GLIMMER_PASS_MATERIAL_INDEX = 10, /* X, 1 + material, 0 if none */
    GLIMMER_PASS_SAMPLE_COUNT = 11,   /* X */
    GLIMMER_PASS_ALPHA = 12, /* A: 1 less the part of the camera's rays that end at a transparent film's environment or
                                in a holdout; 1 elsewhere */
    GLIMMER_PASS_POSITION = 13,    /* XYZ of the first sample's first surface, in the scene's coordinates; 0 if none */
    GLIMMER_PASS_UV = 14,          /* UVA: texture coordinates of the first surface, and 1; 0 if none */
    GLIMMER_PASS_MIST = 15,        /* Z: see glimmer_film_desc; 1 where there is no surface */
    GLIMMER_PASS_EMIT = 16,        /* RGB: what surfaces, lamps and media send to the camera by themselves */
    GLIMMER_PASS_ENVIRONMENT = 17, /* RGB: the same of the environment, also where the film is transparent */
    /* RGB: all other light by what scattered it last before the camera, mirrors and glass among them: `direct` what
     * came there straight from lights, `indirect` the rest. With emit and environment they add up to the combined
     * picture. `color`: the albedo there, of what is seen directly or through transparent surfaces. */
    GLIMMER_PASS_DIFFUSE_DIRECT = 18,
    GLIMMER_PASS_DIFFUSE_INDIRECT = 19,
    GLIMMER_PASS_DIFFUSE_COLOR = 20,
    GLIMMER_PASS_GLOSSY_DIRECT = 21, /* reflected, but not diffusely */
    GLIMMER_PASS_GLOSSY_INDIRECT = 22,
    GLIMMER_PASS_GLOSSY_COLOR = 23,
    GLIMMER_PASS_TRANSMISSION_DIRECT = 24, /* to the other side of the surface */
    GLIMMER_PASS_TRANSMISSION_INDIRECT = 25,
    GLIMMER_PASS_TRANSMISSION_COLOR = 26,
    GLIMMER_PASS_VOLUME_DIRECT = 27,
    GLIMMER_PASS_VOLUME_INDIRECT = 28,
    /* Pairs of a number and the part of the pixel that it takes up, GLIMMER_MATTE_RANKS of them, the largest part
     * first, 0 0 where there are no more: `matte` of the objects that the camera sees, and 1 + their materials. */
    GLIMMER_PASS_OBJECT_MATTE = 29,
    GLIMMER_PASS_MATERIAL_MATTE = 30,
    /* RGB: the part of the combined picture that is light from the lights of group 1, 2, ... GLIMMER_MAX_LIGHT_GROUPS.
     * With any of them, light in media comes by paths alone: slower, and the same mean. */
    GLIMMER_PASS_LIGHT_GROUP = 31,
    /* RGBA: what the materials of surfaces that the camera sees are bound to by "aov_1", "aov_2", ... GLIMMER_MAX_AOVS
     * (a number in R), and the part of the pixel where they are; what is seen through adds up. See glimmer_scene_bind.
     */
    GLIMMER_PASS_AOV = 47,
    /* RGB: the part of directions above a surface (by its cosine) where nothing is within the film's occlusion_distance
     */
    GLIMMER_PASS_AMBIENT_OCCLUSION = 55,
    GLIMMER_PASS_COUNT = 56
} glimmer_pass;
#define GLIMMER_MATTE_RANKS 16
#define GLIMMER_MAX_LIGHT_GROUPS 16
#define GLIMMER_MAX_AOVS 8

/* How the samples of a pixel become its value of a pass, and how pictures of several seeds are merged. */
typedef enum glimmer_pass_rule {
    GLIMMER_RULE_MEAN = 0,           /* the mean of the samples; merged by sample counts */
    GLIMMER_RULE_STANDARD_ERROR = 1, /* of the combined mean; merged as the errors of independent means */
    GLIMMER_RULE_MEAN_OF_HITS = 2,   /* the mean of the samples that hit a surface; GLIMMER_NO_DEPTH where none did */
    GLIMMER_RULE_FIRST = 3,          /* the first sample's: an index is not a quantity */
    GLIMMER_RULE_COUNT = 4,          /* merged by adding */
    GLIMMER_RULE_MATTE = 5           /* of pairs of a number and its part; merged by taking the first picture's */
} glimmer_pass_rule;
#define GLIMMER_NO_DEPTH 1e10f

typedef struct glimmer_pass_info_t {
    const char *name;     /* "combined", "stderr", "albedo", ... as in --aov */
    const char *channels; /* "RGB", "XYZ", "UVA", "Z", "X", "A", or one letter or digit each of a matte's */
    const char *help;     /* one line */
    glimmer_pass_rule rule;
} glimmer_pass_info_t;
/* Null when pass is out of range. */
GLIMMER_API const glimmer_pass_info_t *glimmer_pass_info(uint32_t pass);

typedef struct glimmer_integrator_info_t {
    const char *name; /* "path", "baseline" */
    const char *help;
    const char *former_name; /* still accepted as a name, with a warning in the report; may be null */
} glimmer_integrator_info_t;
/* Null when index is out of range; 0 is the default. */
GLIMMER_API const glimmer_integrator_info_t *glimmer_integrator_info(uint32_t index);

typedef struct glimmer_render_desc {
    size_t struct_size;
    const char *integrator; /* null: the default */
    uint64_t samples;       /* per pixel; 0: no limit */
    double seconds;         /* render wall time; 0: no limit */
    double target_error;    /* relMSE: its interval's upper end, at a doubling of the samples from 16 on, unless the
                               tails are heavy; 0: no limit. With no limit at all: 64 samples */
    uint64_t seed;
    uint32_t threads;    /* 0: all */
    uint32_t tile_size;  /* pixels; 0: 64. Changes no pixel */
    int64_t max_depth;   /* scattering vertices of a path; -1: no limit (a limit is a bias, and named as one) */
    int64_t max_scatter; /* the same for volume vertices alone */
    uint32_t passes;     /* bit set of (1 << glimmer_pass); combined is always there. 32 and up: passes_above */
    int adaptive;    /* not 0: from 16 samples on, pixels that need it take more samples and others fewer, 1/4 to 4 a
                        pass; `samples`, here and in progress and tile, is then the mean over the picture. Unbiased;
                        0 by default */
    int full_kernel; /* not 0: the code that can render any scene, in place of what was compiled for ones like this:
                        slower, the same bits; for tests. 0 by default */
    uint32_t passes_above;  /* bit set of (1 << (glimmer_pass - 32)) */
    int independent_pixels; /* not 0: each sample counts for one pixel, drawn by the pixel's filter, as denoisers need
                               it; else for every pixel whose filter holds it, which has less noise. 0 by default */
} glimmer_render_desc;

GLIMMER_API void glimmer_render_init(glimmer_render_desc *desc);
GLIMMER_API glimmer_result glimmer_render_create(glimmer_scene *scene, const glimmer_render_desc *desc,
                                                 glimmer_render **render);
/* Cancels, waits for the workers and frees. */
GLIMMER_API void glimmer_render_destroy(glimmer_render *render);

typedef enum glimmer_render_state {
    GLIMMER_READY = 0, /* created, not started */
    GLIMMER_RUNNING = 1,
    GLIMMER_PAUSED = 2,
    GLIMMER_FINISHED = 3, /* a limit was reached */
    GLIMMER_CANCELLED = 4,
    GLIMMER_FAILED = 5 /* glimmer_render_wait returns why */
} glimmer_render_state;

/* Starts the workers and returns at once. */
GLIMMER_API glimmer_result glimmer_render_start(glimmer_render *render);
/* Returns when the workers rest. Pausing what does not run and resuming what is not paused change nothing. */
GLIMMER_API glimmer_result glimmer_render_pause(glimmer_render *render);
GLIMMER_API glimmer_result glimmer_render_resume(glimmer_render *render);
/* Asks the workers to stop; within 100 ms they have. What was finished can still be read. */
GLIMMER_API glimmer_result glimmer_render_cancel(glimmer_render *render);
/* Returns when the render has ended or after `seconds` (negative: no limit). The result of a failed render is its
 * failure. */
GLIMMER_API glimmer_result glimmer_render_wait(glimmer_render *render, double seconds);

typedef struct glimmer_progress {
    size_t struct_size;
    glimmer_render_state state;
    uint64_t samples;    /* per pixel, of all pixels */
    double fraction;     /* 0 to 1, of the limit that will be met first; 0 when nothing tells */
    double seconds;      /* wall time in the render so far, pauses left out */
    double seconds_left; /* estimate; negative when nothing tells */
    double cpu_seconds;
    double relmse, relmse_low, relmse_high; /* NaN when not known; the interval holds at all looks at once */
    uint64_t rays;
    uint64_t peak_bytes;      /* of the scene with its BVHs, the film, and what the pixels of the open waves share */
    uint64_t invalid_samples; /* NaN or infinite, left out of the means and named in the report */
    uint64_t version;         /* grows whenever a pixel changed */
    /* Of the error, one pixel (x, y of the crop) of one replicate carries this share; NaN when not known. Above 0.1 the
     * tails are too heavy to certify any interval, and target_error does not end the render. */
    int heavy_tails;
    uint32_t largest_x, largest_y;
    double largest_share;
    double rate, rate_low, rate_high; /* relmse falls as seconds^-rate; NaN when not known */
    double seconds_to_half;           /* until relmse is half of what it was when last estimated; negative: not known */
    double seconds_to_target;         /* until target_error ends the render; negative: not known */
} glimmer_progress;

GLIMMER_API void glimmer_progress_init(glimmer_progress *progress);
GLIMMER_API glimmer_result glimmer_render_poll(glimmer_render *render, glimmer_progress *progress);

typedef struct glimmer_tile {
    uint32_t x, y, width, height; /* in pixels of the crop, from its top left */
    uint64_t samples;             /* that every pixel of it now has */
} glimmer_tile;

/* The next tile whose pixels changed since it was last handed out; *found is 0 when there is none now. */
GLIMMER_API glimmer_result glimmer_render_next_tile(glimmer_render *render, glimmer_tile *tile, int *found);

/* The running mean of a rectangle of a pass, at any time (also while rendering: every pixel is then the mean of whole
 * samples). pixels: (height, width, channels of the pass) float32, value_count in all, which is checked. */
GLIMMER_API glimmer_result glimmer_render_read(glimmer_render *render, glimmer_pass pass, uint32_t x, uint32_t y,
                                               uint32_t width, uint32_t height, float *pixels, size_t value_count);

/* The report of SCENE_FORMAT.md as JSON (load and build seconds are the scene's own); valid until the next call on this
 * render. */
GLIMMER_API glimmer_result glimmer_render_report(glimmer_render *render, const char **json);

/* The state of a paused or ended render (or one that has not started), to be taken up by a render of the same scene,
 * seed and integrator; ends with the very bits of an uninterrupted one. *data is valid until the next call on this
 * render. */
GLIMMER_API glimmer_result glimmer_render_save(glimmer_render *render, const void **data, size_t *size);
/* Before glimmer_render_start. */
GLIMMER_API glimmer_result glimmer_render_load(glimmer_render *render, const void *data, size_t size);

/* ---- The curve of the error ----------------------------------------------------------------------------------- */

/* A point of the report's "curve": the error of the picture at one moment of its render. */
typedef struct glimmer_curve_point {
    double seconds, cpu_seconds;
    double samples;                         /* per pixel */
    double relmse, relmse_low, relmse_high; /* NaN when not known */
} glimmer_curve_point;

/* CSV: a line of names and a line for each point, what is not known left empty. *table is valid until the next call of
 * this function on this thread. */
GLIMMER_API glimmer_result glimmer_error_curve_table(const glimmer_curve_point *points, size_t count,
                                                     const char **table);

typedef struct glimmer_plot_desc {
    size_t struct_size;
    uint32_t width, height; /* pixels, 200 to 8192 each; default 960 x 600. From a width of 600 on with a legend */
    float background[3], text[3], line[3], guide[3]; /* sRGB, 0 to 1. Default: on white */
} glimmer_plot_desc;

GLIMMER_API void glimmer_plot_init(glimmer_plot_desc *desc);
/* relMSE against seconds, both axes logarithmic: the interval is a band, and the guide falls from the last point as
 * 1/time does. Points whose error is not known are left out; without any, the plot says so. rgb: (height, width, 3)
 * bytes, top row first, byte_count in all, which is checked. */
GLIMMER_API glimmer_result glimmer_plot_error_curve(const glimmer_curve_point *points, size_t count,
                                                    const glimmer_plot_desc *desc, uint8_t *rgb, size_t byte_count);

#ifdef __cplusplus
}
#endif
#endif
