#pragma once

/// Marks what libmmgrasp shows; everything else is compiled with hidden visibility.
#define MMGRASP_EXPORT __attribute__((visibility("default")))
