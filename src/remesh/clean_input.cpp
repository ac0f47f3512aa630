#include "remesh/clean_input.h"

#include "mesh/weld.h"
#include "meshgrain/clean.h"
#include "remesh/notes.h"

namespace meshgrain {

std::vector<std::string> clean_input(Mesh& input, const Context& context) {
  const std::size_t merged = is_torn(input) ? weld(input) : 0;
  std::vector<std::string> notes = describe(clean(input, context));
  if (merged > 0) {
    notes.insert(notes.begin(), "merged " + std::to_string(merged) +
                                    " vertices into others at the same place, as faces shared few");
  }
  return notes;
}

}  // namespace meshgrain
