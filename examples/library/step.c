/* A step of a mesh from C99: a triangle falls through a resting one. Its collisions, and the step
 * size of a line search. */

#include <stdio.h>
#include <touchstone/touchstone.h>

int main(void) {
  const double before[18] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 1, 3, 1, 1, 1, 3, 1};
  const double after[18] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, -2, 3, 1, -2, 1, 3, -2};
  const int32_t faces[6] = {0, 1, 2, 3, 4, 5};
  TouchstoneMesh mesh = touchstone_empty_mesh();
  mesh.vertices = 6;
  mesh.before = before;
  mesh.after = after;
  mesh.faces = 2;
  mesh.face_vertices = faces;

  TouchstoneStep* step = NULL;
  const TouchstoneCollision* collisions = NULL;
  size_t count = 0;
  TouchstoneLineSearchLimit limit;
  if (touchstone_step_new(&mesh, NULL, &step) != TOUCHSTONE_OK ||
      touchstone_step_collisions(step, &collisions, &count) != TOUCHSTONE_OK ||
      touchstone_step_line_search_limit(step, 0.5, NULL, &limit) != TOUCHSTONE_OK) {
    fprintf(stderr, "%s\n", touchstone_last_error());
    touchstone_step_free(step);
    return 2;
  }
  for (size_t i = 0; i < count; ++i) {
    const TouchstonePair pair = collisions[i].pair;
    printf("kind %d: %d and %d from t = %.17g\n", (int)pair.kind, (int)pair.first, (int)pair.second,
           collisions[i].toi_lower);
  }
  printf("half of the distance %.17g is left at the step size %.17g\n", limit.distance.lower,
         limit.step_size);
  touchstone_step_free(step);
  return count > 0 ? 1 : 0;
}
