// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// HELIXNAV_CLONES before a function: one binary for all x86-64 machines, with the widest vectors that the machine at hand
/// has. Results are the same bytes on one machine; between machines with and without fused multiply-add they differ in the
/// last digits. Off under sanitizers, whose runtime is not up when the choice is made, and for clang, which has no
/// architecture levels here.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
#if __has_attribute(target_clones)
#define HELIXNAV_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#endif
#endif
#ifndef HELIXNAV_CLONES
#define HELIXNAV_CLONES
#endif
