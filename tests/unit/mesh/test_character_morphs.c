/* Morph targets of formats other than glTF. */
#include "harness/mesh/character.h"
#include "tests/support/folder.h"
#include "tests/support/test.h"

/* A triangle and a target that raises it by 5. */
static const char fbx[] = "; FBX 7.4.0 project file\n"
                          "FBXHeaderExtension: {\n"
                          "FBXVersion: 7400\n"
                          "}\n"
                          "Objects: {\n"
                          "Geometry: 1, \"Geometry::base\", \"Mesh\" {\n"
                          "Vertices: *9 { a: 0,0,0,1,0,0,0,1,0 }\n"
                          "PolygonVertexIndex: *3 { a: 0,1,-3 }\n"
                          "}\n"
                          "Geometry: 2, \"Geometry::up\", \"Shape\" {\n"
                          "Indexes: *3 { a: 0,1,2 }\n"
                          "Vertices: *9 { a: 0,0,5,0,0,5,0,0,5 }\n"
                          "Normals: *9 { a: 0,0,0,0,0,0,0,0,0 }\n"
                          "}\n"
                          "Model: 3, \"Model::n\", \"Mesh\" {\n"
                          "}\n"
                          "Deformer: 4, \"Deformer::d\", \"BlendShape\" {\n"
                          "}\n"
                          "Deformer: 5, \"SubDeformer::up\", \"BlendShapeChannel\" {\n"
                          "DeformPercent: 40\n"
                          "FullWeights: *1 { a: 100 }\n"
                          "}\n"
                          "}\n"
                          "Connections: {\n"
                          "C: \"OO\",3,0\n"
                          "C: \"OO\",1,3\n"
                          "C: \"OO\",4,1\n"
                          "C: \"OO\",5,4\n"
                          "C: \"OO\",2,5\n"
                          "}\n";

/* assimp says 1 of every channel of an FBX file, whatever its DeformPercent. */
TEST(morph_targets_of_fbx_rest)
{
    mote_character *c = NULL;
    file_put("m.fbx", fbx);
    if (mote_character_import_file("m.fbx", &c, NULL) != MOTE_OK)
        fail_msg("%s", mote_error_text());
    mote_character_pose pose = mote_character_pose_create(c);
    mote_character_pose_set(c, MOTE_RIG_NONE, 0, &pose);
    assert_int_equal(c->rig.targets_count, 1);
    assert_int_equal(c->shift_start[c->mesh->vertex_count], 3);
    assert_true(c->shift[0].z == 5);
    assert_true(pose.morphs[0] == 0);
    mote_character_pose_free(&pose);
    mote_character_destroy(c);
}
