/* The structs of shaders/shared.h lie in buffers as C lays them out: no device. */
#include "gpu_test.h"

#include "../../shaders/shared.h"
#include "gpu/program.h"

struct expected {
    const char *name; /* NULL ends a struct */
    size_t offset, size;
};

static const struct expected expected[] = {
#define STRUCT(s) {#s, 0, sizeof(struct s)},
#define MEMBER(s, m) {#m, offsetof(struct s, m), sizeof(((struct s *)0)->m)},
#define END(s) {NULL, 0, 0},
#include "shared_members.h"
#undef STRUCT
#undef MEMBER
#undef END
};

/* A shader that has an array of each struct in a buffer. */
static const char shader[] =
    "#version 460\n"
    "#extension GL_EXT_buffer_reference : require\n"
    "#extension GL_EXT_scalar_block_layout : require\n"
    "#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require\n"
    "#include \"shared.h\"\n"
    "layout(push_constant) uniform push_block { uint64_t address; } push;\n"
#define STRUCT(s) "layout(buffer_reference, scalar) buffer array_of_" #s " { " #s " at[]; };\n"
#define MEMBER(s, m)
#define END(s)
#include "shared_members.h"
#undef STRUCT
#undef END
    "void main()\n{\n"
#define STRUCT(s) "    { array_of_" #s " a = array_of_" #s "(push.address); a.at[1] = a.at[0]; }\n"
#define END(s)
#include "shared_members.h"
    "}\n";

static const struct expected *next; /* the member that is due */

static void check_member(void *user, const char *name, uint32_t offset, uint32_t size)
{
    const char *parent = user;
    if (!next->name)
        fail_msg("%s has no member %s in C", parent, name);
    assert_string_equal(name, next->name);
    if (offset != next->offset || size != next->size)
        fail_msg("%s.%s: %u bytes at %u in the shader, %zu at %zu in C", parent, name, size, offset,
                 next->size, next->offset);
    next++;
}

static void structs_lie_alike(void **state)
{
    (void)state;
    struct turner_shader_source source;
    struct turner_spirv spirv;
    assert_ok(turner_shader_source_from_text(&source, "layout.comp", shader, NULL, 0));
    assert_ok(turner_compile(&spirv, &source, NULL, 0));
    int structs = 0;
    next = expected;
    while (next < expected + sizeof expected / sizeof *expected) {
        const struct expected *parent = next++;
        uint32_t stride;
        assert_ok(turner_reflect_struct(&spirv, parent->name, check_member, (void *)parent->name,
                                        &stride));
        assert_null(next->name); /* all members seen */
        next++;
        assert_int_equal(stride, parent->size);
        structs++;
    }
    assert_true(structs >= 10);

    uint32_t stride;
    assert_int_equal(turner_reflect_struct(&spirv, "no_such_struct", check_member, NULL, &stride),
                     TURNER_BAD_INPUT);
    assert_message_has("the shader has no struct no_such_struct in a buffer");
    turner_spirv_destroy(&spirv);
    turner_shader_source_destroy(&source);
}

static struct found {
    char name[16];
    uint32_t offset, size;
} found[8];
static size_t found_count;

static void note_member(void *user, const char *name, uint32_t offset, uint32_t size)
{
    (void)user;
    assert_true(found_count < sizeof found / sizeof *found);
    struct found *member = &found[found_count++];
    snprintf(member->name, sizeof member->name, "%s", name);
    member->offset = offset;
    member->size = size;
}

/* That the reflection can tell: the same struct under std430 lies otherwise. */
static void other_layouts_are_seen(void **state)
{
    (void)state;
    for (int scalar = 0; scalar < 2; scalar++) {
        char text[512];
        snprintf(text, sizeof text,
                 "#version 460\n"
                 "#extension GL_EXT_scalar_block_layout : require\n"
                 "struct thing { float a; vec3 b; float c[2]; mat2 d; };\n"
                 "layout(binding = 0, %s) buffer block { uint n; thing things[]; };\n"
                 "void main() { thing t = things[n]; t.a++; things[n + 1] = t; }\n",
                 scalar ? "scalar" : "std430");
        struct turner_shader_source source;
        struct turner_spirv spirv;
        assert_ok(turner_shader_source_from_text(&source, "layout.comp", text, NULL, 0));
        assert_ok(turner_compile(&spirv, &source, NULL, 0));
        uint32_t stride;
        found_count = 0;
        assert_ok(turner_reflect_struct(&spirv, "thing", note_member, NULL, &stride));
        assert_int_equal(found_count, 4);
        assert_string_equal(found[1].name, "b");
        assert_int_equal(found[0].offset, 0);
        assert_int_equal(found[1].offset, scalar ? 4 : 16);
        assert_int_equal(found[2].offset, scalar ? 16 : 28);
        assert_int_equal(found[3].offset, scalar ? 24 : 40);
        assert_int_equal(found[1].size, 12);
        assert_int_equal(found[2].size, 8);
        assert_int_equal(stride, scalar ? 40 : 64);
        turner_spirv_destroy(&spirv);
        turner_shader_source_destroy(&source);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(structs_lie_alike),
        cmocka_unit_test(other_layouts_are_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
