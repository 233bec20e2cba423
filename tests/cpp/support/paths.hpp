#pragma once

/// Where test data lies. Included into every test by the build (the paths are compiled into paths.cpp alone, so that
/// clones in different folders share compiled tests).
namespace mmgrasp::testing_support {
const char* shared_data_folder();  ///< May be absent.
const char* assets_folder();
}  // namespace mmgrasp::testing_support

#define MMGRASP_SHARED_DATA mmgrasp::testing_support::shared_data_folder()
#define MMGRASP_ASSETS mmgrasp::testing_support::assets_folder()
