/* The only file that speaks to SPIRV-Tools' optimiser, which is C++. */
#include <cstring>
#include <spirv-tools/optimizer.hpp>
#include <spirv_cross/spirv.h>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

extern "C" {
#include "base/memory.h"
#include "gpu/specialise.h"
}

using words = std::vector<uint32_t>;

/* What inlining makes of a parameter that is a buffer's address is a variable that lacks the
 * decoration such variables must have. */
static void decorate(words &spirv)
{
    const size_t header = 5;
    std::unordered_set<uint32_t> addresses, holders, decorated;
    words missing;
    size_t first_type = 0;
    for (size_t i = header; i < spirv.size() && spirv[i] >> 16; i += spirv[i] >> 16) {
        const uint32_t *word = &spirv[i], op = word[0] & 0xffff;
        if (!first_type && op >= SpvOpTypeVoid && op <= SpvOpTypeForwardPointer)
            first_type = i;
        if (op == SpvOpDecorate && (word[2] == SpvDecorationAliasedPointer ||
                                    word[2] == SpvDecorationRestrictPointer))
            decorated.insert(word[1]);
        else if (op == SpvOpTypePointer && word[2] == SpvStorageClassPhysicalStorageBuffer)
            addresses.insert(word[1]);
        else if (op == SpvOpTypePointer && addresses.count(word[3]))
            holders.insert(word[1]);
        else if (op == SpvOpVariable && holders.count(word[1]) && !decorated.count(word[2]))
            missing.insert(missing.end(),
                           {3u << 16 | SpvOpDecorate, word[2], SpvDecorationAliasedPointer});
    }
    spirv.insert(spirv.begin() + static_cast<ptrdiff_t>(first_type), missing.begin(),
                 missing.end());
}

enum class effort { fold, reduce, optimise };

/* Constants, and what they decide. */
static void fold(spvtools::Optimizer &optimizer,
                 const std::unordered_map<uint32_t, words> &values)
{
    optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
        .RegisterPass(spvtools::CreateStripDebugInfoPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
}

static void reduce(spvtools::Optimizer &optimizer)
{
    optimizer.RegisterPass(spvtools::CreateMergeReturnPass()) /* others are not inlined */
        .RegisterPass(spvtools::CreateInlineExhaustivePass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
        .RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
        .RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
        .RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass())
        .RegisterPass(spvtools::CreateBlockMergePass())
        /* Once more, with what is left of structures in parts: a twentieth of a warm start. */
        .RegisterPass(spvtools::CreatePrivateToLocalPass())
        .RegisterPass(spvtools::CreateScalarReplacementPass(0))
        .RegisterPass(spvtools::CreateLocalAccessChainConvertPass())
        .RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
        .RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass());
}

static enum turner_result run(struct turner_spirv *out, const struct turner_spirv *spirv,
                              const struct turner_constant *constants, size_t count,
                              effort wanted)
{
    *out = {};
    std::unordered_map<uint32_t, words> values;
    for (size_t i = 0; i < count; i++)
        values[constants[i].id] = {constants[i].value};

    std::string said;
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
    optimizer.SetMessageConsumer([&said](spv_message_level_t level, const char *,
                                         const spv_position_t &, const char *message) {
        if (level <= SPV_MSG_ERROR && said.empty())
            said = message;
    });
    fold(optimizer, values);
    if (wanted != effort::fold)
        reduce(optimizer);
    if (wanted == effort::optimise)
        optimizer.RegisterPerformancePasses();
    spvtools::OptimizerOptions options;
    options.set_run_validator(false); /* turner_spirv_validate does that */
    words left;
    if (!optimizer.Run(spirv->words, spirv->count, &left, options))
        return turner_fail(TURNER_BAD_INPUT, "SPIRV-Tools cannot specialise the shader: %s",
                           said.empty() ? "no reason given" : said.c_str());
    decorate(left);
    out->count = left.size();
    out->words = static_cast<uint32_t *>(turner_calloc(left.size(), sizeof *out->words));
    std::memcpy(out->words, left.data(), left.size() * sizeof *out->words);
    return TURNER_OK;
}

enum turner_result turner_spirv_specialise(struct turner_spirv *out,
                                           const struct turner_spirv *spirv,
                                           const struct turner_constant *constants, size_t count)
{
    return run(out, spirv, constants, count, effort::optimise);
}

enum turner_result turner_spirv_reduce(struct turner_spirv *out, const struct turner_spirv *spirv,
                                       const struct turner_constant *constants, size_t count,
                                       bool soon)
{
    return run(out, spirv, constants, count, soon ? effort::fold : effort::reduce);
}
