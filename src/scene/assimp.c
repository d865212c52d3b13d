#include "scene/assimp.h"

__attribute__((visibility("default"))) const struct turner_assimp *turner_assimp_module(void)
{
    static const struct turner_assimp module = {TURNER_VERSION,  aiAttachLogStream,
                                                aiDetachLogStream, aiImportFile,
                                                aiReleaseImport, aiGetErrorString};
    return &module;
}
