#include "support/paths.hpp"

namespace mmgrasp::testing_support {

const char* shared_data_folder() {
  return MMGRASP_SHARED_DATA_FOLDER;
}
const char* assets_folder() {
  return MMGRASP_ASSETS_FOLDER;
}

}  // namespace mmgrasp::testing_support
