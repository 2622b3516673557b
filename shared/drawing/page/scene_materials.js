// What the scene in space is made of: faces, edges, paths and points. Their colours are the page's.

function sceneMaterials() {
  const T = TenonLibraries;
  const faces = (options) =>
    new T.MeshLambertMaterial({
      side: T.DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
      ...options,
    });
  const lines = (options) => new T.LineBasicMaterial({ transparent: true, ...options });
  return {
    environment: faces({}),
    touched: faces({}),
    environmentEdges: lines({ opacity: 0.35 }),
    // Behind whatever really stands in the same plane.
    nominal: faces({ transparent: true, opacity: 0.1, depthWrite: false, polygonOffsetFactor: 4 }),
    nominalEdges: lines({ opacity: 0.4 }),
    front: faces({}),
    frontEdges: lines({ opacity: 0.9 }),
    // Behind the front part, where all have come to the same place.
    particle: faces({ transparent: true, opacity: 0.08, depthWrite: false, polygonOffsetFactor: 4 }),
    particleEdges: lines({ opacity: 0.3 }),
    goal: lines({ opacity: 0.9 }),
    path: lines({ opacity: 0.85 }),
    whisker: lines({ opacity: 1, depthTest: false }),
    draws: new T.PointsMaterial({ size: 3, sizeAttenuation: false, transparent: true, opacity: 0.4 }),
    tips: new T.PointsMaterial({ size: 7, sizeAttenuation: false, depthTest: false, transparent: true }),
    arrow: new T.MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.9 }),
  };
}
