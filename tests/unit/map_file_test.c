/* SPDX-License-Identifier: AGPL-3.0-or-later */
#define _XOPEN_SOURCE 700   /* mkdtemp, setrlimit */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <locale.h>
#include <math.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "made_map.h"

static char text[MAP_REASON_SIZE];
static map_reason why = {text, sizeof text};
static void write_map(const char *path, made_map *m) {
  if (map_file_write(path, &m->header, give_made, m, NULL, &why) != DSM_OK) fail_msg("%s", text);
}

static map_file *open_map(const char *path, map_header *header) {
  map_file *file;
  if (map_file_open(path, header, &file, &why) != DSM_OK) fail_msg("%s", text);
  return file;
}

static void assert_refused(const char *path, const char *part_of_sentence) {
  map_header header;
  map_file *file;
  text[0] = '\0';
  dsm_result result = map_file_open(path, &header, &file, &why);
  if (result == DSM_OK) fail_msg("%s was opened, although: %s", path, part_of_sentence);
  assert_int_equal(result, DSM_REFUSED);
  assert_null(file);
  if (!strstr(text, part_of_sentence) || !strstr(text, path) || text[strlen(text) - 1] != '.')
    fail_msg("\"%s\" does not say: %s", text, part_of_sentence);
}

static unsigned char *bytes_of(const char *path, size_t *size) {
  FILE *f = fopen(path, "rb");
  assert_non_null(f);
  fseek(f, 0, SEEK_END);
  *size = (size_t)ftell(f);
  rewind(f);
  unsigned char *bytes = malloc(*size + 1);
  assert_int_equal(fread(bytes, 1, *size, f), *size);
  fclose(f);
  return bytes;
}

static void put_bytes(const char *path, const void *bytes, size_t size) {
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(bytes, 1, size, f), size);
  assert_int_equal(fclose(f), 0);
}

static int same_headers(const map_header *a, const map_header *b) {
  attribute_list x, y;
  assert_int_equal(map_header_write(a, &x), DSM_OK);
  assert_int_equal(map_header_write(b, &y), DSM_OK);
  int same = x.count == y.count;
  for (uint32_t i = 0; same && i < x.count; ++i)
    same = strcmp(x.items[i].name, y.items[i].name) == 0 && strcmp(x.items[i].text, y.items[i].text) == 0;
  attribute_list_free(&x);
  attribute_list_free(&y);
  /* 17 digits tell doubles apart; some are compared as they are, not to rely on that alone */
  return same && memcmp(&a->light.origin, &b->light.origin, sizeof a->light.origin) == 0
      && memcmp(&a->projection.faces[0].axes, &b->projection.faces[0].axes, sizeof(frame)) == 0;
}

/* Grey and coloured maps, marked pixels, lit tiles, tiles too large for the narrow table, one face and six, some of them empty,
 * and levels down to one pixel. */
static void what_is_written_is_read(void **state) {
  (void)state;
  int lit = 0, wide = 0, marked = 0, coloured = 0;
  for (uint64_t seed = 0; seed < 24; ++seed) {
    rng r = rng_seeded(seed);
    made_map m = made_map_random(&r, seed % 2 ? MAX_FACES : 1, seed == 0 ? 300 : 50, seed % 3 == 0, seed % 8 == 7 ? 400 : 12);
    const char *path = made_path("round.exr");
    write_map(path, &m);
    map_header header;
    map_file *file = open_map(path, &header);
    assert_seeded(&r, same_headers(&m.header, &header));
    dsm_result result = DSM_OK;
    uint64_t differs = made_map_differs(&m, file, &result, &why);
    if (result != DSM_OK) fail_msg("seed %d: %s", (int)seed, text);
    assert_seeded(&r, differs == m.parts.tile_count);
    for (uint64_t i = 0; i < m.parts.tile_count; ++i) {
      lit += m.tiles[i] == &tile_lit;
      wide += m.tiles[i]->layout & TILE_WIDE;
      marked += m.tiles[i]->layout & TILE_MARKED;
      coloured += m.tiles[i]->layout & TILE_COLOURED;
    }
    map_file_close(file);
    map_header_free(&header);
    made_map_free(&m);
  }
  assert_true(lit && wide && marked && coloured);
  assert_int_equal(made_folder_files(1), 1);
}

/* A map of no casters has no tiles. */
static void an_empty_map(void **state) {
  (void)state;
  for (int kind = MADE_GREY; kind <= MADE_DEPTHS; ++kind) {
    rng r = rng_seeded(1);
    made_map m = made_map_random(&r, 0, 1, kind, 1);
    const char *path = made_path("empty.exr");
    write_map(path, &m);
    map_header header;
    map_file *file = open_map(path, &header);
    assert_true(header.projection.count == 0 && same_headers(&m.header, &header));
    map_file_close(file);
    map_header_free(&header);
    made_map_free(&m);
  }
}

/* Every value that a vertex can have, in grey and in colour. */
static void all_values_survive(void **state) {
  (void)state;
  rng r = rng_seeded(2);
  for (int coloured = 0; coloured < 2; ++coloured) {
    made_map m = made_map_random(&r, 1, 1, coloured, 1);
    while (m.parts.tile_count == 0) {
      made_map_free(&m);
      m = made_map_random(&r, 1, 1, coloured, 1);
    }
    tile_plan plan = {.count = {0}};
    memset(&plan, 0, sizeof plan);
    for (int i = 0; i < TILE_PIXELS; ++i) {
      plan.count[i] = 256;
      plan.coloured[i] = coloured != 0;
    }
    tile *t = tile_create(&plan);
    assert_non_null(t);
    for (uint32_t i = 0; i < TILE_PIXELS; ++i)
      for (uint32_t k = 0; k < 256; ++k) {
        uint16_t value = (uint16_t)(VALUE_STEPS - (i * 256 + k));
        for (uint32_t c = 0; c < (coloured ? 3 : 1); ++c)
          tile_put(t, i, k, c, (float)k, (uint16_t)(c == 1 ? value / 2 : value));
      }
    t = tile_compact(t);
    tile_destroy(m.tiles[0]);
    m.tiles[0] = t;
    const char *path = made_path("values.exr");
    write_map(path, &m);
    map_header header;
    map_file *file = open_map(path, &header);
    const tile *back;
    assert_int_equal(map_file_tile(file, &m.parts.keys[0], &back, &why), DSM_OK);
    assert_true(same_tiles(t, back));
    tile_destroy(back);
    map_file_close(file);
    map_header_free(&header);
    made_map_free(&m);
  }
}

static void same_map_same_bytes(void **state) {
  (void)state;
  rng r = rng_seeded(3);
  made_map m = made_map_random(&r, 6, 40, 1, 9);
  write_map(made_path("a.exr"), &m);
  write_map(made_path("b.exr"), &m);
  write_map(made_path("b.exr"), &m);   /* over itself */
  size_t a_size, b_size;
  unsigned char *a = bytes_of(made_path("a.exr"), &a_size), *b = bytes_of(made_path("b.exr"), &b_size);
  assert_true(a_size == b_size && memcmp(a, b, a_size) == 0);
  free(a);
  free(b);
  made_map_free(&m);
}

/* Wherever a file is cut off, it is refused, and its beginning is never used. */
static void cut_file_of(int kind) {
  rng r = rng_seeded(4);
  made_map m = made_map_random(&r, 6, 20, kind, 5);
  const char *path = made_path("whole.exr"), *cut = made_path("cut.exr");
  write_map(path, &m);
  size_t size;
  unsigned char *bytes = bytes_of(path, &size);
  for (size_t length = 0; length < size; length += length + 40 > size ? 1 : 1 + rng_below(&r, (uint32_t)(size / 300 + 1))) {
    put_bytes(cut, bytes, length);
    assert_refused(cut, length < 4 ? "is not an OpenEXR file" : "damaged or cut off");
  }
  free(bytes);
  made_map_free(&m);
}

static void a_cut_file_is_refused(void **state) {
  (void)state;
  cut_file_of(MADE_GREY);
  cut_file_of(MADE_DEPTHS);
}

/* A tile's bytes may be damaged behind the back of an open file, and then it is refused by itself. */
static int read_all(const char *path, const made_map *m, int *refused_late) {
  map_header header;
  map_file *file;
  dsm_result result = map_file_open(path, &header, &file, &why);
  if (result != DSM_OK) return assert_int_equal(result, DSM_REFUSED), 1;
  int same = same_headers(&header, &m->header);
  uint64_t differs = same ? made_map_differs(m, file, &result, &why) : 0;
  map_file_close(file);
  map_header_free(&header);
  *refused_late += result == DSM_REFUSED;
  return result == DSM_REFUSED || (same && differs == m->parts.tile_count);
}

static void flipped_bit_of(int kind) {
  rng r = rng_seeded(5);
  made_map m = made_map_random(&r, 1, 40, kind, 4);
  while (m.parts.tile_count < 3) {
    made_map_free(&m);
    m = made_map_random(&r, 1, 40, kind, 4);
  }
  const char *path = made_path("flip.exr");
  write_map(path, &m);
  size_t size;
  unsigned char *bytes = bytes_of(path, &size);
  int late = 0, runs = (int)most_cases(3000);
  for (int i = 0; i < runs; ++i) {
    size_t at = (size_t)(rng_unit(&r) * (double)size);
    unsigned char before = bytes[at], flip = (unsigned char)(rng_below(&r, 2) ? 1u << rng_below(&r, 8) : 1 + rng_below(&r, 255));
    bytes[at] ^= flip;
    put_bytes(path, bytes, size);
    if (!read_all(path, &m, &late)) fail_msg("byte %zu of %zu, %02x to %02x: read, but not the same", at, size, before, bytes[at]);
    bytes[at] = before;
  }
  assert_true(late > 0 && late < runs);
  free(bytes);
  made_map_free(&m);
}

static void a_flipped_bit_is_noticed_or_harmless(void **state) {
  (void)state;
  flipped_bit_of(MADE_COLOURED);
  flipped_bit_of(MADE_DEPTHS);
}

/* Replaces all of a text in a file by another one of the same length. */
static void change_text(const char *from, const char *to, const char *old, const char *new) {
  size_t size, length = strlen(old), found = 0;
  assert_int_equal(strlen(new), length);
  unsigned char *bytes = bytes_of(from, &size);
  for (size_t i = 0; i + length <= size; ++i)
    if (memcmp(bytes + i, old, length) == 0) {
      memcpy(bytes + i, new, length);
      ++found;
    }
  assert_true(found > 0);
  put_bytes(to, bytes, size);
  free(bytes);
}

static void each_refusal_has_its_sentence(void **state) {
  (void)state;
  rng r = rng_seeded(6);
  made_map m = made_map_random(&r, 6, 20, 0, 5);
  const char *path = made_path("map.exr"), *other = made_path("other.exr");
  write_map(path, &m);
  assert_refused(made_path("missing.exr"), "There is no shadow map");
  assert_refused(made_path("no/where.exr"), "There is no shadow map");
  assert_refused(made_folder, "is not the name of a file");
  put_bytes(other, "#version 3.7;\n", 14);
  assert_refused(other, "is not an OpenEXR file");
  put_bytes(other, "", 0);
  assert_refused(other, "is not an OpenEXR file");
  change_text(path, other, "dsm:format", "dsm:fromat");
  assert_refused(other, "is an OpenEXR image, but not a shadow map");
  change_text(path, other, "dsm:faces", "dsm:feces");
  assert_refused(other, "is damaged: its header cannot be read");
  change_text(path, other, "f0.l0", "f0.l9");
  assert_refused(other, "parts");
  if (geteuid() != 0) {
    assert_int_equal(chmod(path, 0), 0);
    assert_refused(path, "cannot be read");
    assert_int_equal(chmod(path, 0600), 0);
  }
  made_map_free(&m);
  made_folder_files(1);
}

static const char *fake_get(void *data, const char *name) {
  const attribute_list *list = data;
  for (uint32_t i = 0; i < list->count; ++i)
    if (strcmp(list->items[i].name, name) == 0) return list->items[i].text;
  return NULL;
}

static void newer_and_older_formats_are_told_apart(void **state) {
  (void)state;
  rng r = rng_seeded(7);
  map_header h = random_header(&r, 1, 20, 0), back;
  attribute_list list;
  assert_int_equal(map_header_write(&h, &list), DSM_OK);
  const char *format = list.items[0].text;
  list.items[0].text = "7";
  assert_int_equal(map_header_read(fake_get, &list, "some.exr", &back, &why), DSM_REFUSED);
  assert_non_null(strstr(text, "has format 7"));
  assert_non_null(strstr(text, "written by a newer one"));
  list.items[0].text = "1";
  assert_int_equal(map_header_read(fake_get, &list, "some.exr", &back, &why), DSM_REFUSED);
  assert_string_equal(text, "The shadow map \"some.exr\" has format 1, and this program reads only formats from 2 on: it was written by an "
                            "older one. Bake the map again, with save_file.");
  static const char *const none[] = {"0", "2", "3 ", "03", "", "three"};
  for (int i = 0; i < 6; ++i) {
    list.items[0].text = none[i];
    assert_int_equal(map_header_read(fake_get, &list, "some.exr", &back, &why), DSM_REFUSED);
    assert_non_null(strstr(text, "is damaged: \"dsm:format\""));
  }
  list.items[0].text = format;
  assert_int_equal(map_header_read(fake_get, &list, "some.exr", &back, &why), DSM_OK);
  map_header_free(&back);
  attribute_list_free(&list);
  map_header_free(&h);
}

/* Whatever is left out or spoilt, the header is refused and no memory is left over. */
static void attributes_count_of(int kind) {
  rng r = rng_seeded(8);
  map_header h = random_header(&r, 6, 20, kind), back;
  attribute_list list;
  assert_int_equal(map_header_write(&h, &list), DSM_OK);
  for (uint32_t i = 0; i < list.count; ++i) {
    const char *name = list.items[i].name, *was = list.items[i].text;
    char spoilt[1000];
    list.items[i].name = "gone";
    assert_int_equal(map_header_read(fake_get, &list, "x", &back, &why), DSM_REFUSED);
    list.items[i].name = name;
    snprintf(spoilt, sizeof spoilt, "%s ", was);
    list.items[i].text = spoilt;
    assert_int_equal(map_header_read(fake_get, &list, "x", &back, &why), DSM_REFUSED);
    snprintf(spoilt, sizeof spoilt, "nan");
    assert_int_equal(map_header_read(fake_get, &list, "x", &back, &why), DSM_REFUSED);
    list.items[i].text = was;
  }
  attribute_list_free(&list);
  map_header_free(&h);
}

static void every_attribute_counts(void **state) {
  (void)state;
  attributes_count_of(MADE_COLOURED);
  attributes_count_of(MADE_DEPTHS);
}

static void numbers_do_not_depend_on_the_language(void **state) {
  (void)state;
  static const char *const commas[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "fr_FR"};
  size_t count = sizeof commas / sizeof *commas, i = 0;
  while (i < count && !setlocale(LC_NUMERIC, commas[i])) ++i;
  if (i == count) skip();   /* this machine speaks no such language */
  rng r = rng_seeded(9);
  map_header h = random_header(&r, 6, 20, 1);
  attribute_list list;
  assert_int_equal(map_header_write(&h, &list), DSM_OK);
  for (uint32_t k = 0; k < list.count; ++k) assert_null(strchr(list.items[k].text, ','));
  setlocale(LC_NUMERIC, "C");
  attribute_list_free(&list);
  map_header_free(&h);
}

/* The old file stays, and nothing else is left. */
static void assert_untouched(const char *path, const unsigned char *bytes, size_t size) {
  size_t now;
  unsigned char *there = bytes_of(path, &now);
  assert_true(now == size && memcmp(there, bytes, size) == 0);
  free(there);
  assert_int_equal(made_folder_files(0), 1);
}

static int stop_in_the_middle(void *data, double share) {
  (void)data;
  assert_true(share >= 0 && share <= 1);
  return share > 0.4;
}

static void a_failure_leaves_the_old_file(void **state) {
  (void)state;
  made_folder_files(1);
  rng r = rng_seeded(10);
  made_map m = made_map_random(&r, 6, 60, 0, 8);
  const char *path = made_path("old.exr");
  write_map(path, &m);
  size_t size;
  unsigned char *bytes = bytes_of(path, &size);

  m.fail_at = m.parts.tile_count / 2;
  static const dsm_result results[] = {DSM_CANCELLED, DSM_NO_MEMORY, DSM_REFUSED};
  for (int i = 0; i < 3; ++i) {
    m.fail_with = results[i];
    assert_int_equal(map_file_write(path, &m.header, give_made, &m, NULL, &why), results[i]);
    assert_untouched(path, bytes, size);
  }
  m.fail_at = UINT64_MAX;
  assert_int_equal(map_file_write(path, &m.header, give_made, &m, stop_in_the_middle, &why), DSM_CANCELLED);
  assert_untouched(path, bytes, size);

  const tile *was = m.tiles[5];
  m.tiles[5] = &tile_failed;
  assert_int_equal(map_file_write(path, &m.header, give_made, &m, NULL, &why), DSM_REFUSED);
  assert_non_null(strstr(text, "could not be baked"));
  m.tiles[5] = was;
  assert_untouched(path, bytes, size);
  free(bytes);
  made_map_free(&m);
}

/* No colour where the header knows of none. */
static void colour_must_be_announced(void **state) {
  (void)state;
  made_folder_files(1);
  rng r = rng_seeded(11);
  made_map m = made_map_random(&r, 6, 60, 1, 8);
  m.header.coloured = 0;
  assert_int_equal(map_file_write(made_path("grey.exr"), &m.header, give_made, &m, NULL, &why), DSM_INVALID);
  assert_int_equal(made_folder_files(0), 0);
  made_map_free(&m);
}

/* The end is read again before the old file goes. */
static void what_cannot_be_read_again_is_not_kept(void **state) {
  (void)state;
  made_folder_files(1);
  rng r = rng_seeded(14);
  made_map m = made_map_random(&r, 6, 60, 0, 8);
  const char *path = made_path("old.exr");
  write_map(path, &m);
  size_t size;
  unsigned char *bytes = bytes_of(path, &size);
  for (uint64_t i = 0; i < m.parts.tile_count; ++i)
    if (m.tiles[i]->kind == TILE_STORED) {
      ((tile *)(size_t)m.tiles[i])->tolerance = 2;   /* no error of visibility is so large */
      break;
    }
  assert_int_equal(map_file_write(path, &m.header, give_made, &m, NULL, &why), DSM_REFUSED);
  assert_non_null(strstr(text, "cannot be read again"));
  assert_untouched(path, bytes, size);
  free(bytes);
  made_map_free(&m);
}

/* Writing stops at every size at which a disk can be full: while tiles are written, and at the very end. */
static void a_full_disk_leaves_the_old_file(void **state) {
  (void)state;
  made_folder_files(1);
  rng r = rng_seeded(12);
  made_map m = made_map_random(&r, 6, 60, 0, 8);
  const char *path = made_path("full.exr");
  write_map(path, &m);
  size_t size;
  unsigned char *bytes = bytes_of(path, &size);
  struct rlimit before, limit;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
  void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
  for (size_t room = 0; room < size; room += room + 50 > size || room < 20 ? 7 : 1 + size / 60) {
    limit = before;
    limit.rlim_cur = room;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    text[0] = '\0';
    dsm_result result = map_file_write(path, &m.header, give_made, &m, NULL, &why);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    if (result != DSM_REFUSED) fail_msg("%zu of %zu bytes fit: %d", room, size, (int)result);
    assert_non_null(strstr(text, "cannot be written"));
    assert_untouched(path, bytes, size);
  }
  signal(SIGXFSZ, handler);
  free(bytes);
  made_map_free(&m);
}

static void where_no_file_can_be(void **state) {
  (void)state;
  made_folder_files(1);
  assert_int_equal(map_file_writable(made_path("new.exr"), &why), DSM_OK);
  assert_int_equal(made_folder_files(0), 0);
  const char *bad[] = {made_path("no/folder.exr"), made_folder, "/dev/full", "/proc/none.exr", ""};
  for (int i = 0; i < 5; ++i) {
    text[0] = '\0';
    assert_int_equal(map_file_writable(bad[i], &why), DSM_REFUSED);
    assert_non_null(strstr(text, "cannot be written"));
  }
  if (geteuid() != 0) {
    put_bytes(made_path("fixed.exr"), "x", 1);
    assert_int_equal(chmod(made_path("fixed.exr"), 0444), 0);
    assert_int_equal(map_file_writable(made_path("fixed.exr"), &why), DSM_REFUSED);
    assert_int_equal(chmod(made_folder, 0500), 0);
    assert_int_equal(map_file_writable(made_path("new.exr"), &why), DSM_REFUSED);
    assert_int_equal(chmod(made_folder, 0700), 0);
  }
  made_folder_files(1);
}

/* A symbolic link stays one, and its file is the one that is written. */
static void a_link_is_followed(void **state) {
  (void)state;
  made_folder_files(1);
  rng r = rng_seeded(13);
  made_map m = made_map_random(&r, 1, 20, 0, 5);
  put_bytes(made_path("real.exr"), "x", 1);
  assert_int_equal(symlink("real.exr", made_path("link.exr")), 0);
  write_map(made_path("link.exr"), &m);
  struct stat link;
  assert_int_equal(lstat(made_path("link.exr"), &link), 0);
  assert_true(S_ISLNK(link.st_mode));
  map_header header;
  map_file_close(open_map(made_path("real.exr"), &header));
  map_header_free(&header);
  assert_int_equal(made_folder_files(1), 2);
  made_map_free(&m);
}

static void a_digest_is_a_sha1(void **state) {
  (void)state;
  char digest[DIGEST_CHARS];
  assert_int_equal(map_digest("abc", 3, digest, &why), DSM_OK);
  assert_string_equal(digest, "A9993E364706816ABA3E25717850C26C9CD0D89D");   /* FIPS 180 */
  assert_int_equal(map_digest("", 0, digest, &why), DSM_OK);
  assert_string_equal(digest, "DA39A3EE5E6B4B0D3255BFEF95601890AFD80709");
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(what_is_written_is_read),
    cmocka_unit_test(an_empty_map),
    cmocka_unit_test(all_values_survive),
    cmocka_unit_test(same_map_same_bytes),
    cmocka_unit_test(a_cut_file_is_refused),
    cmocka_unit_test(a_flipped_bit_is_noticed_or_harmless),
    cmocka_unit_test(each_refusal_has_its_sentence),
    cmocka_unit_test(newer_and_older_formats_are_told_apart),
    cmocka_unit_test(every_attribute_counts),
    cmocka_unit_test(numbers_do_not_depend_on_the_language),
    cmocka_unit_test(a_failure_leaves_the_old_file),
    cmocka_unit_test(colour_must_be_announced),
    cmocka_unit_test(what_cannot_be_read_again_is_not_kept),
    cmocka_unit_test(a_full_disk_leaves_the_old_file),
    cmocka_unit_test(where_no_file_can_be),
    cmocka_unit_test(a_link_is_followed),
    cmocka_unit_test(a_digest_is_a_sha1),
  };
  return cmocka_run_group_tests(tests, made_folder_open, made_folder_close);
}
