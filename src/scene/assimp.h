/* What turner has of assimp, which takes longer to load than turner itself: a module (base/module.h),
 * for the scenes that have meshes in files. */
#ifndef TURNER_SCENE_ASSIMP_H
#define TURNER_SCENE_ASSIMP_H

#include <assimp/cimport.h>
#include <assimp/scene.h>

struct turner_assimp {
    const char *version; /* turner's, of the build it comes from */
    __typeof__(aiAttachLogStream) *attach_log;
    __typeof__(aiDetachLogStream) *detach_log;
    __typeof__(aiImportFile) *import;
    __typeof__(aiReleaseImport) *release;
    __typeof__(aiGetErrorString) *error;
};

/* The module's only function. */
const struct turner_assimp *turner_assimp_module(void);

#endif
