/* How a shared library tells mote which methods and fields it has. Users need only MOTE_METHOD
   (core/method/method.h) and MOTE_FIELD (core/body/field_maker.h). */
#ifndef MOTE_CORE_PLUGIN_H
#define MOTE_CORE_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

/* The version of the contract between mote and methods or fields that were compiled elsewhere.
   It is raised whenever code that was compiled against an older one would not work: another
   layout or meaning of the structs of method.h and what it includes, or of field_maker.h. A
   library that was built for another version is refused, with both numbers. */
#define MOTE_CONTRACT 1

enum {
    MOTE_PLUGIN_METHOD = 1, /* item is a const mote_method */
    MOTE_PLUGIN_FIELD = 2   /* item is a const mote_field_maker */
};

/* The first two members never change. */
typedef struct mote_plugin_item {
    uint32_t contract; /* MOTE_CONTRACT of the headers that it was compiled with */
    uint32_t kind;
    uint32_t size; /* of the structs that both sides use, in bytes: shows a change of layout for
                      which nobody raised the version */
    const void *item;
} mote_plugin_item;

/* The type of mote_plugin_items, which each such library exports. It returns the library's
   items. */
typedef const mote_plugin_item *const *(*mote_plugin_items_type)(size_t *count);

#ifdef __cplusplus
#define MOTE_PLUGIN_DECLARE extern "C"
#else
#define MOTE_PLUGIN_DECLARE extern
#endif

#ifdef MOTE_IN_TREE
#define MOTE_PLUGIN_ITEM(kind, size, item)
#else
/* Pointers to the items of all source files lie side by side in a section of their own, whose
   ends the linker knows. (Items would not: the compiler may align them further apart than their
   size.) A program that only includes the headers has none. */
#define MOTE_PLUGIN_SECTION __attribute__((section("mote_plugin"), used))
#define MOTE_PLUGIN_ITEM(kind, size, item)                                                     \
    static const mote_plugin_item item##_item = {MOTE_CONTRACT, kind, (uint32_t)(size),        \
                                                 &item};                                       \
    MOTE_PLUGIN_SECTION static const mote_plugin_item *const item##_listed = &item##_item;

#ifdef __cplusplus
extern "C" {
#endif
extern const mote_plugin_item *const __start_mote_plugin[]
    __attribute__((weak, visibility("hidden")));
extern const mote_plugin_item *const __stop_mote_plugin[]
    __attribute__((weak, visibility("hidden")));

__attribute__((weak, visibility("default"))) const mote_plugin_item *const *
mote_plugin_items(size_t *count);

__attribute__((weak, visibility("default"))) const mote_plugin_item *const *
mote_plugin_items(size_t *count)
{
    *count = (size_t)(__stop_mote_plugin - __start_mote_plugin);
    return __start_mote_plugin;
}
#ifdef __cplusplus
}
#endif
#endif

#endif
