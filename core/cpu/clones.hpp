// One copy of a function for each instruction set, chosen when the program starts. Not under sanitizers,
// whose runtime is not up yet at that time.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define GVOM_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
/// The same where the copies differ in their source: one definition for each.
#define GVOM_CLONE_FOR(instructions) __attribute__((target(instructions)))
#define GVOM_CLONE_DEFAULT __attribute__((target("default")))
#else
#define GVOM_CLONES
#define GVOM_CLONE_DEFAULT
#endif

/// For what a cloned function calls: it must be compiled with its caller's instructions.
#define GVOM_INLINE inline __attribute__((always_inline))

/// Before a loop over arrays that do not overlap.
#if defined(__GNUC__) && !defined(__clang__)
#define GVOM_INDEPENDENT _Pragma("GCC ivdep")
#else
#define GVOM_INDEPENDENT
#endif
