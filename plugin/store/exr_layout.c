/* SPDX-License-Identifier: AGPL-3.0-or-later */
#define _FILE_OFFSET_BITS 64   /* also where `long` has 32 */
#include "store/exr_layout.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "store/deep_exr.h"

enum {
  MOST_PARTS = 128,          /* six faces of fifteen levels, and the table */
  MOST_NAME = 255,           /* bytes of an attribute's name, and of its type */
  MOST_SIDE = 1 << 20,       /* pixels along a side of a part */
  MULTIPART = 0x1000,        /* of the version's flags */
  HEAD = 5 * 4,              /* of a tile: its part (in files of several), x, y, level x, level y */
  DEEP_SIZES = 3 * 8,        /* of packed counts, packed samples, and samples */
  FLAT_SIZES = 4,            /* of packed pixels */
  MOST_PACKING = 1032        /* deflate makes no more of a byte */
};

typedef struct {
  int deep;
  uint32_t across, up;       /* tiles */
  uint64_t tiles;            /* as the part itself counts them */
  uint64_t table;            /* where in the file its tiles' places are */
} exr_part;

struct exr_layout {
  int file;
  uint64_t size;             /* bytes of the file */
  uint64_t tiles_begin;      /* behind all headers and tables */
  uint32_t part_count;
  int alone;                 /* a file of one part, which does without some numbers */
  exr_part parts[MOST_PARTS];
};

static uint32_t u32_of(const unsigned char *b) { return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24; }
static uint64_t u64_of(const unsigned char *b) { return u32_of(b) | (uint64_t)u32_of(b + 4) << 32; }

/* 0: the file is not that long, or cannot be read. */
static int bytes_at(const exr_layout *l, uint64_t place, void *out, size_t size)
{
  if (place > l->size || size > l->size - place)
    return 0;
  for (size_t done = 0; done < size;) {
    ssize_t n = pread(l->file, (char *)out + done, size - done, (off_t)(place + done));
    if (n > 0)
      done += (size_t)n;
    else if (n == 0 || errno != EINTR)
      return 0;
  }
  return 1;
}

/* A text that ends with a zero byte; its length, or -1. */
static int text_at(const exr_layout *l, uint64_t place, char text[MOST_NAME + 1])
{
  uint64_t left = place < l->size ? l->size - place : 0;
  size_t most = left < MOST_NAME + 1 ? (size_t)left : MOST_NAME + 1;
  if (!bytes_at(l, place, text, most))
    return -1;
  const char *end = memchr(text, 0, most);
  return end ? (int)(end - text) : -1;
}

typedef struct {
  char name[MOST_NAME + 1], type[MOST_NAME + 1];
  uint64_t place;
  uint32_t size;
} attribute;

/* A list of channels ends with an empty name, and each of the others is followed by 16 bytes. */
static int list_fits(const exr_layout *l, const attribute *a)
{
  uint64_t place = a->place, end = a->place + a->size;
  for (int length = 1; length > 0 && place < end; place += (uint64_t)length + (length ? 17 : 1)) {
    char name[MOST_NAME + 1];
    length = text_at(l, place, name);
    if (length < 0)
      return 0;
    if (length == 0)
      return place + 1 == end;
  }
  return 0;
}

/* OpenEXR reads as many bytes as the type takes, whatever the size says, and would then take values for names. These are all
 * the types that a map has. */
static int size_fits(const exr_layout *l, const attribute *a)
{
  static const struct { const char *type; uint32_t size; } fixed[] = {
    {"box2i", 16}, {"compression", 1}, {"double", 8}, {"float", 4}, {"int", 4}, {"lineOrder", 1}, {"tiledesc", 9}, {"v2f", 8},
  };
  if (!strcmp(a->type, "string"))
    return 1;
  if (!strcmp(a->type, "chlist"))
    return list_fits(l, a);
  for (size_t i = 0; i < sizeof fixed / sizeof *fixed; i++)
    if (!strcmp(a->type, fixed[i].type))
      return a->size == fixed[i].size;
  return 0;
}

/* Moves `place` behind the attribute there. An empty name ends a header. */
static int next_attribute(const exr_layout *l, uint64_t *place, attribute *a)
{
  unsigned char size[4];
  int length = text_at(l, *place, a->name);
  if (length < 0)
    return 0;
  *place += (uint64_t)length + 1;
  if (length == 0)
    return 1;
  length = text_at(l, *place, a->type);
  if (length < 0 || !bytes_at(l, *place + (uint64_t)length + 1, size, sizeof size))
    return 0;
  a->place = *place + (uint64_t)length + 1 + sizeof size;
  a->size = u32_of(size);
  *place = a->place + a->size;
  return a->size <= INT32_MAX && *place <= l->size && size_fits(l, a);
}

/* The few attributes that say how much memory a part takes. */
static int take_attribute(const exr_layout *l, const attribute *a, exr_part *part)
{
  unsigned char b[16] = {0};
  if (!bytes_at(l, a->place, b, a->size < sizeof b ? a->size : sizeof b))
    return 0;
  if (!strcmp(a->name, "chunkCount")) {
    part->tiles = u32_of(b);
    return a->size == 4;
  }
  if (!strcmp(a->name, "tiles"))   /* with one level, whatever the rounding of others */
    return a->size == 9 && u32_of(b) == DEEP_SIDE && u32_of(b + 4) == DEEP_SIDE && (b[8] & 15) == 0;
  if (!strcmp(a->name, "type")) {
    part->deep = a->size == 8 && !memcmp(b, "deeptile", 8);
    return part->deep || (a->size == 10 && !memcmp(b, "tiledimage", 10));
  }
  if (!strcmp(a->name, "dataWindow")) {
    uint32_t right = u32_of(b + 8), top = u32_of(b + 12);
    part->across = right / DEEP_SIDE + 1;
    part->up = top / DEEP_SIDE + 1;
    return a->size == 16 && u32_of(b) == 0 && u32_of(b + 4) == 0 && right < MOST_SIDE && top < MOST_SIDE;
  }
  return 1;
}

static int read_header(exr_layout *l, uint64_t *place, exr_part *part)
{
  attribute a;
  *part = (exr_part){0};
  for (;;) {
    if (!next_attribute(l, place, &a))
      return 0;
    if (!a.name[0]) {
      uint64_t tiles = (uint64_t)part->across * part->up;
      if (l->alone && !part->deep)
        part->tiles = tiles;   /* which need not be told */
      return tiles > 0 && part->tiles == tiles;
    }
    if (!take_attribute(l, &a, part))
      return 0;
  }
}

/* An empty header ends several. */
static int read_headers(exr_layout *l)
{
  uint64_t place = 8;
  unsigned char first[8], next = 1;
  if (!bytes_at(l, 0, first, sizeof first))
    return 0;
  l->alone = !(u32_of(first + 4) & MULTIPART);
  do {
    if (l->part_count == MOST_PARTS || !read_header(l, &place, &l->parts[l->part_count++]))
      return 0;
    if (!l->alone && !bytes_at(l, place, &next, 1))
      return 0;
  } while (!l->alone && next);
  l->tiles_begin = place + !l->alone;
  for (uint32_t i = 0; i < l->part_count; i++) {
    l->parts[i].table = l->tiles_begin;
    l->tiles_begin += 8 * l->parts[i].tiles;
  }
  return l->part_count > 0 && l->tiles_begin <= l->size;
}

/* A place of zero makes OpenEXR look for lost tiles all over the file. */
static int check_places(const exr_layout *l)
{
  unsigned char b[8 * 512];
  uint64_t end = l->tiles_begin;
  for (uint64_t at = l->parts[0].table; at < end;) {
    size_t size = end - at < sizeof b ? (size_t)(end - at) : sizeof b;
    if (!bytes_at(l, at, b, size))
      return 0;
    for (size_t i = 0; i < size; i += 8)
      if (u64_of(b + i) < end || u64_of(b + i) > l->size)
        return 0;
    at += size;
  }
  return 1;
}

dsm_result exr_layout_open(const char *path, exr_layout **out)
{
  struct stat there;
  *out = NULL;
  exr_layout *l = calloc(1, sizeof *l);
  if (!l)
    return DSM_NO_MEMORY;
  l->file = open(path, O_RDONLY | O_CLOEXEC);
  if (l->file >= 0 && fstat(l->file, &there) == 0 && there.st_size > 0) {
    l->size = (uint64_t)there.st_size;
    if (read_headers(l) && check_places(l)) {
      *out = l;
      return DSM_OK;
    }
  }
  exr_layout_close(l);
  return DSM_REFUSED;
}

void exr_layout_close(exr_layout *l)
{
  if (!l)
    return;
  if (l->file >= 0)
    close(l->file);
  free(l);
}

/* `b` is what follows the five numbers of every tile. How many bytes follow it, or UINT64_MAX if that makes no sense. */
static uint64_t packed_size(const exr_part *part, const unsigned char *b, uint64_t left)
{
  if (!part->deep)
    return u32_of(b) <= left ? u32_of(b) : UINT64_MAX;
  uint64_t counts = u64_of(b), packed = u64_of(b + 8), samples = u64_of(b + 16);
  int fits = counts <= 4 * DEEP_PIXELS && packed <= left - (counts < left ? counts : left) && counts <= left
          && samples <= MOST_PACKING * packed;
  return fits ? counts + packed : UINT64_MAX;
}

/* Bytes of a tile, or 0: it is not where it should be. */
static uint64_t tile_bytes(const exr_layout *l, uint32_t index, uint32_t x, uint32_t y)
{
  unsigned char b[HEAD + DEEP_SIZES] = {0};
  const exr_part *part = &l->parts[index];
  size_t less = l->alone ? 4 : 0, head = HEAD + (part->deep ? DEEP_SIZES : FLAT_SIZES) - less;
  if (!bytes_at(l, part->table + 8 * ((uint64_t)y * part->across + x), b, 8))
    return 0;
  uint64_t place = u64_of(b);
  memset(b, 0, sizeof b);   /* the number of a part that is alone */
  if (!bytes_at(l, place, b + less, head) || u32_of(b) != index || u32_of(b + 4) != x || u32_of(b + 8) != y
      || u32_of(b + 12) != 0 || u32_of(b + 16) != 0)
    return 0;
  uint64_t packed = packed_size(part, b + HEAD, l->size - place - head);
  return packed < UINT64_MAX ? head + packed : 0;
}

int exr_layout_tile(const exr_layout *l, uint32_t index, uint32_t x, uint32_t y)
{
  return index < l->part_count && x < l->parts[index].across && y < l->parts[index].up && tile_bytes(l, index, x, y) > 0;
}

uint64_t exr_layout_bytes(const exr_layout *l, uint32_t index)
{
  uint64_t sum = 0;
  for (uint64_t i = 0; index < l->part_count && i < l->parts[index].tiles; i++)
    sum += 8 + tile_bytes(l, index, (uint32_t)(i % l->parts[index].across), (uint32_t)(i / l->parts[index].across));
  return sum;
}
