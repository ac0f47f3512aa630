// From a mesh to a mesh: minimal [INPUT [OUTPUT]]. Without an input, a shape that is made.

#include <meshgrain/meshgrain.h>

#include <iostream>

int main(int argc, char** argv) {
  try {
    meshgrain::Mesh input =
        argc > 1 ? meshgrain::read_mesh(argv[1]) : meshgrain::sample_shape("bracket");

    meshgrain::RemeshOptions options;
    options.face_count = 2000;
    const meshgrain::RemeshResult result = meshgrain::remesh(std::move(input), options);

    meshgrain::write_mesh(argc > 2 ? argv[2] : "minimal.obj", result.mesh);
    std::cout << result.mesh.faces.size() << " quads\n";
    return 0;
  } catch (const meshgrain::Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
