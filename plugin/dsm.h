/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * dsm.h - shadow maps, deep ones and depth maps, behind one table of C functions.
 *
 * A renderer (the *host*) loads this library at run time, finds the one symbol `dsm_api`, and drives it
 * through the table that the symbol holds. The library bakes a map of fractional visibility for one light by
 * asking the host to trace light rays, and answers during shading how much of the light reaches a point.
 * Lokovic & Veach, "Deep Shadow Maps", SIGGRAPH 2000 (LV below), is the method. A map can also be a depth map with
 * percentage closer filtering: Reeves, Salesin & Cook, "Rendering Antialiased Shadows with Depth Maps", SIGGRAPH 1987
 * (RSC). It is made, kept and asked in the same way, and holds one depth a pixel: where half of the light is gone.
 *
 * RULES
 *
 * Versions    The host compares `abi` with DSM_ABI and `size` with the part of the table it knows before it
 *             touches anything else. Tables and structures that carry a `size` only ever grow at the end.
 * Threads     [any]  may be called from any thread, at the same time, for the same object.
 *             [one]  one thread at a time for each object.
 *             The library starts no threads and has no mutable globals.
 * Results     Functions that can fail return a `dsm_result`. The sentence that explains a failure goes to
 *             `dsm_host.report` on the calling thread, before the function returns.
 * Ownership   create gives, destroy takes, destroy(NULL) does nothing. Nobody frees what the other allocated.
 * Exceptions  None crosses this interface, in either direction.
 * Numbers     All lengths are scene units, all colours linear. Transmittance is the share of light that passes:
 *             1 is clear, 0 is opaque, one value for each of red, green and blue. NaN, negative depths and
 *             transmittances outside [0,1] that a host reports are dropped or clamped as `dsm_sink` says,
 *             counted, and reported once a map.
 * Depth       Distance from the light's origin (DSM_LIGHT_POINT, DSM_LIGHT_SPOT) or from the light's plane
 *             (DSM_LIGHT_PARALLEL), so that the faces of a cube meet without a seam.
 * Determinism Samples are a hash of pixel and sample number. Any number of threads and any order of look-ups
 *             bake the same bytes, as long as the host's `trace` gives the same events for the same ray.
 * Memory      Tiles of a map hold at most `cache` megabytes, and what the tiles of one look-up take for each thread. Tiles
 *             that have not been used for long are given up, and made or read again when needed.
 * Files       What reads and writes files is loaded when a file is first named. It may start threads of its own.
 */
#ifndef DSM_H
#define DSM_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define DSM_ABI 3u

typedef int32_t dsm_result;
enum {
  DSM_OK = 0,
  DSM_OUTSIDE = 1,    /* look-up: nothing in the map can shadow the point; visibility is 1 */
  DSM_TRACE = 2,      /* look-up: the map has no answer here (light grows, an occluder too close to the surface to be told
                         from it, or the tile failed): trace the ray */
  DSM_CANCELLED = 3,  /* the host's `pause` asked to stop; the tile is absent again */
  DSM_NO_MEMORY = 4,
  DSM_INVALID = 5,    /* an argument or a setting is out of its range */
  DSM_REFUSED = 6,    /* a file cannot be read, used or written; the sentence says which, and what is wrong with it */
  DSM_DONE = 7        /* bake_next: no tile is left to take */
};

/* ---- Settings: the blocks that a light can have, and their words ----------------------------------------- */

typedef enum {
  DSM_NUMBERS,  /* `min_count` to `max_count` numbers */
  DSM_CHOICE,   /* one of `choices`, followed by up to `max_count` numbers */
  DSM_TEXT      /* a string that is not empty: the name of a file */
} dsm_type;

/* One row of a published table. Parser, documentation and tools all read this and nothing else. */
typedef struct {
  const char *name;
  dsm_type type;
  uint32_t min_count, max_count;
  int32_t integral;              /* nonzero: numbers must be whole */
  double low, high;              /* range of each number; `high` is DBL_MAX where there is no upper limit */
  int32_t low_open, high_open;   /* nonzero: the range excludes `low`, `high` */
  const char *choices;           /* DSM_CHOICE: the words, separated by single spaces; else NULL */
  const char *default_text;      /* as the documentation prints it */
  const char *meaning;           /* one line */
} dsm_parameter;

/* A kind of map, by the block that asks for it. */
typedef struct {
  const char *name;                  /* "deep_shadow": a deep map; "shadow_map": a depth map */
  const dsm_parameter *parameters;
  uint32_t parameter_count;
} dsm_block;

typedef struct dsm_settings dsm_settings;

/* ---- The light, as the host describes it --------------------------------------------------------------- */

typedef enum {
  DSM_LIGHT_POINT,     /* from `origin`, in all directions */
  DSM_LIGHT_SPOT,      /* from `origin`, within `cos_angle` of `direction` */
  DSM_LIGHT_PARALLEL   /* along `direction`, from the plane through `origin` on; see `radius` */
} dsm_light_kind;

typedef struct { double low[3], high[3]; } dsm_box;   /* axis-aligned, low <= high, finite */

typedef struct {
  uint32_t size;
  uint32_t kind;             /* dsm_light_kind */
  double origin[3];
  double direction[3];       /* unit length; not read for DSM_LIGHT_POINT */
  double cos_angle;          /* DSM_LIGHT_SPOT: cosine of the half angle beyond which there is no light */
  double radius;             /* DSM_LIGHT_PARALLEL: no light farther than this from the axis; 0: no such limit */
  const dsm_box *casters;    /* one box for each finite object that casts a shadow; outlives the map */
  uint64_t caster_count;     /* 0: the map is all lit */
} dsm_light;

/* ---- What the host does for the library ---------------------------------------------------------------- */

/* One light ray. Points of it are origin + depth * direction, near <= depth <= far. */
typedef struct {
  double origin[3];
  double direction[3];   /* unit length, away from the light */
  double near_depth, far_depth;
} dsm_ray;

/* Where `trace` puts what it finds. Grows; nothing is dropped for want of room. */
typedef struct dsm_sink dsm_sink;

typedef struct {
  uint32_t size;
  void *data;   /* handed to `report` */

  /* [any worker, one thread a worker] Report all that dims each of the `count` rays between its two depths, in any
   * order, to `sink` (sink_surface, sink_span, sink_mark). `tolerance` is the largest error of transmittance
   * that matters: spans may be as long as light falls exponentially within them to that precision. A batch is
   * a set of neighbouring rays of one light; several workers may trace batches of one tile at a time. Returns DSM_OK, DSM_CANCELLED or DSM_NO_MEMORY. */
  dsm_result (*trace)(void *worker_data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink);

  /* Called often, at least every 20 ms, while the library works or waits. Nonzero asks it to give up. */
  int32_t (*pause)(void *worker_data);

  /* [any] One complete sentence for the user. `severity`: 0 note, 1 warning, 2 error. */
  void (*report)(void *data, int32_t severity, const char *sentence);
} dsm_host;

/* ---- Maps, workers, look-ups ----------------------------------------------------------------------------- */

typedef struct dsm_map dsm_map;         /* one light's map; tiles are baked when first needed */
typedef struct dsm_worker dsm_worker;   /* one thread's scratch memory for one map */

/* A surface around a point P stays below the plane through P with this normal, moved by `rise` towards the light. */
typedef struct {
  double normal[3];   /* unit length, on the light's side */
  double rise;        /* scene units along the light ray, >= 0 */
} dsm_plane;

/* Where the light is wanted. A point on a surface must not be shadowed by that surface. Every plane given is a bound
 * by itself on where the surface is within the filter's footprint around the point (a tangent plane for a smooth
 * surface, one across the light for a small object); the library uses the one that needs the least bias. */
typedef struct {
  double point[3];
  uint32_t plane_count;     /* 0: no surface here (media), or one that the map does not hold */
  uint32_t has_footprint;   /* 0: only the point counts */
  dsm_plane planes[2];      /* the first is the tangent plane at the point */
  /* The sides of the parallelogram around the point over which the answer is averaged, scene units: what one camera ray
   * stands for. */
  double footprint[2][3];
} dsm_receiver;

typedef struct {
  uint32_t size;
  uint32_t faces;
  uint64_t tiles, tiles_baked, tiles_failed;
  uint64_t pixels, pixels_baked, pixels_marked, pixels_coloured;
  uint64_t rays, events, events_dropped, events_clamped;
  uint64_t vertices_in;    /* of all averaged visibility functions, before compression */
  uint64_t vertices;       /* stored; of a depth map, its finite depths */
  uint64_t bytes;          /* held by tiles now, bookkeeping included */
  uint64_t bytes_most;     /* the most that tiles have held at a time */
  uint64_t tiles_read;     /* from a file */
  uint64_t tiles_evicted;  /* given up to stay within `cache` */
  double near_depth, far_depth;
  double bake_seconds;     /* of all workers, host's tracing included */
  double trace_seconds;    /* the part of bake_seconds spent in host->trace */
  uint64_t samples;        /* depth maps: compared by all look-ups; zero for others */
  uint64_t tiles_again;    /* made once more after they had been given up */
} dsm_statistics;

/* A square of a face's finest tiles, (x, y) to (past_x - 1, past_y - 1), of which one tile of `level` is made. */
typedef struct {
  uint32_t face, level;
  uint32_t x, y, past_x, past_y;
} dsm_tiles;

typedef struct {
  uint32_t abi;    /* DSM_ABI */
  uint32_t size;   /* of this table, in bytes */
  const char *version;

  const dsm_block *blocks;   /* [any] */
  uint32_t block_count;

  /* Settings start at the defaults of their block, an index, and make a map of its kind. settings_set checks against the
   * block's table and returns DSM_INVALID, with a sentence that names the word and its range, without changing anything.
   * `parameter` is an index into that table. */
  dsm_settings *(*settings_create)(uint32_t block);         /* [any] NULL: out of memory, or there is no such block */
  dsm_result (*settings_set)(dsm_settings *settings, uint32_t parameter, const char *choice,
                             const double *numbers, uint32_t count, char *why, uint64_t why_size); /* [one] */
  /* What a DSM_TEXT parameter was set to, NULL if it was not. Lives as long as the settings. */
  const char *(*settings_text)(const dsm_settings *settings, uint32_t parameter);      /* [any] */
  void (*settings_destroy)(dsm_settings *settings);                           /* [one] */

  /* Fits faces to the casters and lays out tiles; traces nothing yet. Settings and light are copied; `host` is
   * copied too, and what it points to must outlive the map. */
  dsm_result (*map_create)(const dsm_host *host, const dsm_light *light, const dsm_settings *settings,
                           dsm_map **map);                                     /* [any] */
  void (*map_destroy)(dsm_map *map);                                          /* [one] after all its workers */

  dsm_result (*worker_create)(dsm_map *map, void *worker_data, dsm_worker **worker);   /* [any] */
  void (*worker_destroy)(dsm_worker *worker);                                 /* [one] */

  /* How much light reaches the receiver: `rgb` in [0,1], 1 is unshadowed. Bakes the tiles it needs, or helps and waits for
   * the thread that does. A deep map is filtered over the pixels around the point (LV 3.4). Of a depth map a number of
   * pixels around the point are compared, at places that are a hash of the point (RSC figure 4); it knows nothing of planes, and
   * all of `rgb` is one number. `rgb` is set when the result is DSM_OK or DSM_OUTSIDE and untouched otherwise. */
  dsm_result (*lookup)(dsm_worker *worker, const dsm_receiver *receiver, double rgb[3]);        /* [one] */

  void (*statistics)(const dsm_map *map, dsm_statistics *out);                /* [any] out->size set by the caller */

  /* Whole maps and their files. The file names among the settings are for the host, which knows where files may lie;
   * here it hands over a path. All trace a few light rays through the worker, to know the scene again: the file of
   * another light, of other settings, or of a scene that has changed is refused with a sentence that says what
   * differs. So is any file for a map with `accuracy`, which is only as fine as what one picture looks at. */

  /* From now on tiles are read from the file when first needed, and never baked. Before the map's first look-up. */
  dsm_result (*load)(dsm_worker *worker, const char *path);                   /* [one] for the map */

  /* Announces that the whole map is to be baked and saved. Fails early if the file cannot be written. */
  dsm_result (*save_begin)(dsm_worker *worker, const char *path);             /* [one] for the map */

  /* Bakes one tile that nobody has taken yet, finest level first, and sets `share` to the part of the map that is
   * done. DSM_OK until there is none left: DSM_DONE. To be called by as many threads as like. */
  dsm_result (*bake_next)(dsm_worker *worker, double *share);                 /* [one] */

  /* Writes the file under a temporary name and renames it: there is the old file or the new one, never half of one.
   * After DSM_DONE everywhere; nobody looks up meanwhile. A map that is destroyed before leaves no file. `share` of the writing goes to
   * `progress`, which may be NULL. */
  dsm_result (*save_end)(dsm_worker *worker, void (*progress)(void *worker_data, double share));   /* [one] for the map */

  /* For `trace`. Equal depths keep the order of the calls. DSM_NO_MEMORY is final for the batch.
   * An event outside [near, far] is moved to the nearer end; one with a NaN or infinite number is dropped;
   * transmittance below 0 becomes 0, above 1 it marks the ray (see sink_mark) and becomes 1. */
  dsm_result (*sink_surface)(dsm_sink *sink, uint32_t ray, double depth, const double transmittance[3]);
  dsm_result (*sink_span)(dsm_sink *sink, uint32_t ray, double front, double back, const double transmittance[3]);
  /* The ray's light can grow with depth (caustics, colours above 1). The map does not store such pixels. */
  dsm_result (*sink_mark)(dsm_sink *sink, uint32_t ray);

  /* What a map will cost can be told before it is used. Tells `wanted` of the tiles that a look-up for this receiver would make,
   * each once or more often, and makes none. */
  dsm_result (*tiles_wanted)(dsm_worker *worker, const dsm_receiver *receiver,
                             void (*wanted)(void *data, const dsm_tiles *tiles), void *data);   /* [one] */
  /* Makes one of the finest tiles, as a look-up would. */
  dsm_result (*bake_tile)(dsm_worker *worker, uint32_t face, uint32_t x, uint32_t y);           /* [one] */

  /* For `trace`. How many rays of the batch, from each multiple of that number on, belong to one map pixel, of which nothing but
   * their average is wanted; 1 where each ray counts. They are spread evenly, and neighbours follow each other: each quarter
   * of them fills a quarter of the pixel, and so on. */
  uint32_t (*sink_pixel_rays)(const dsm_sink *sink);
  /* The ray does not count, nor what was reported of it: the pixel's other rays tell as much. One of them must be left. */
  dsm_result (*sink_spare)(dsm_sink *sink, uint32_t ray);

  /* A map with `accuracy` spares light rays if it is shown a few places of the picture before the first look-up: what camera rays that are spread
   * over it would ask for. It looks at them with its coarsest pixels. `explored` says how many camera rays that were, and how many lie side by
   * side in an image pixel; from then on look-ups read the map as coarse as that picture allows. */
  dsm_result (*explore)(dsm_worker *worker, const dsm_receiver *receiver);                      /* [one] for the map */
  void (*explored)(dsm_map *map, uint64_t camera_rays, double rays_across);                     /* [one] for the map */
} dsm_api_table;

/* The one exported symbol. */
#ifndef DSM_IMPORT
extern const dsm_api_table dsm_api;
#endif

#ifdef __cplusplus
}
#endif
#endif
