/* The only file that speaks to SPIRV-Tools' optimiser, which is C++. */
#include <cstring>
#include <spirv-tools/optimizer.hpp>
#include <string>
#include <unordered_map>
#include <vector>

extern "C" {
#include "base/memory.h"
#include "gpu/specialise.h"
}

static enum turner_result run(struct turner_spirv *out, const struct turner_spirv *spirv,
                              const struct turner_constant *constants, size_t count, bool optimise)
{
    *out = {};
    std::unordered_map<uint32_t, std::vector<uint32_t>> values;
    for (size_t i = 0; i < count; i++)
        values[constants[i].id] = {constants[i].value};

    std::string said;
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
    optimizer.SetMessageConsumer([&said](spv_message_level_t level, const char *,
                                         const spv_position_t &, const char *message) {
        if (level <= SPV_MSG_ERROR && said.empty())
            said = message;
    });
    optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
        .RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass());
    if (optimise)
        optimizer.RegisterPerformancePasses();
    else
        optimizer.RegisterPass(spvtools::CreateStripDebugInfoPass())
            .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
    spvtools::OptimizerOptions options;
    options.set_run_validator(false); /* turner_spirv_validate does that */
    std::vector<uint32_t> words;
    if (!optimizer.Run(spirv->words, spirv->count, &words, options))
        return turner_fail(TURNER_BAD_INPUT, "SPIRV-Tools cannot specialise the shader: %s",
                           said.empty() ? "no reason given" : said.c_str());
    out->count = words.size();
    out->words = static_cast<uint32_t *>(turner_calloc(words.size(), sizeof *out->words));
    std::memcpy(out->words, words.data(), words.size() * sizeof *out->words);
    return TURNER_OK;
}

enum turner_result turner_spirv_specialise(struct turner_spirv *out,
                                           const struct turner_spirv *spirv,
                                           const struct turner_constant *constants, size_t count)
{
    return run(out, spirv, constants, count, true);
}

enum turner_result turner_spirv_reduce(struct turner_spirv *out, const struct turner_spirv *spirv,
                                       const struct turner_constant *constants, size_t count)
{
    return run(out, spirv, constants, count, false);
}
