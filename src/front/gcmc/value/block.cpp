// Release of counted blocks. In a separate file: compilers that also see the allocations warn of wrong types.
#include <cassert>

#include "front/gcmc/value/value.h"

namespace kerf::gcmc {

void release(Block* block) {
  if (--block->owners != 0) return;
  block->meter->shrink(block->charged);
  switch (block->type) {
    case Type::long_vector: delete static_cast<LongVector*>(block); break;
    case Type::list: delete static_cast<List*>(block); break;
    case Type::string: delete static_cast<Text*>(block); break;
    default: assert(false);
  }
}

}  // namespace kerf::gcmc
