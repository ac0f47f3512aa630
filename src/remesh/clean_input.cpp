#include "remesh/clean_input.h"

#include "mesh/contract_border.h"
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

std::vector<std::string> contract_border_of(Mesh& input, std::vector<std::array<Index, 2>>& border,
                                            const Context& context) {
  const std::size_t merged = contract_border(input, border, context);
  if (merged == 0) return {};
  return {"merged " + std::to_string(merged) +
          " vertices of the border into others, as edges between them have no length"};
}

}  // namespace meshgrain
