// Box2D 3 compiled for the web (box2d3-wasm): what `--to box2d` says under "3".
import Box2DFactory from 'box2d3-wasm';

const B = await Box2DFactory();
const vec = ([x, y]) => new B.b2Vec2(x, y);
const substeps = 8;

export function load(doc, choose) {
  const worldDef = B.b2DefaultWorldDef();
  worldDef.gravity = vec(doc.gravity);
  const world = B.b2CreateWorld(worldDef);
  const bodies = {};
  for (const b of doc.bodies) {
    const def = B.b2DefaultBodyDef();
    def.type = {static: B.b2BodyType.b2_staticBody, kinematic: B.b2BodyType.b2_kinematicBody,
                dynamic: B.b2BodyType.b2_dynamicBody}[b.type];
    def.position = vec(b.position);
    def.linearVelocity = vec(b.linearVelocity);
    def.angularVelocity = b.angularVelocity;
    def.enableSleep = b.allowSleep;
    const body = bodies[b.name] = B.b2CreateBody(world, def);
    for (const f of b.fixtures) {
      const shape = B.b2DefaultShapeDef();
      shape.density = f.density;
      shape.material.friction = f.friction;
      shape.material.restitution = f.restitution;
      shape.filter.groupIndex = f.groupIndex;
      if (f.polygon) {
        B.b2CreatePolygonShape(body, shape, B.b2MakePolygon(B.b2ComputeHull(f.polygon.map(vec)), 0));
      } else {
        const disc = new B.b2Circle();
        disc.radius = f.circle;
        disc.center = vec(f.center);
        B.b2CreateCircleShape(body, shape, disc);
      }
    }
    if (b.type === 'dynamic') {
      const mass = new B.b2MassData();
      mass.mass = b.mass;
      mass.center = vec([0, 0]);
      mass.rotationalInertia = b.inertia;
      B.b2Body_SetMassData(body, mass);
    }
  }
  const kinds = {weld: 'Weld', revolute: 'Revolute', prismatic: 'Prismatic', wheel: 'Wheel'};
  for (const joint of doc.joints) {
    const {type, localFrameA, localFrameB, ...fields} = choose(joint)['3'];
    const def = B[`b2Default${kinds[type]}JointDef`]();
    def.base.bodyIdA = bodies[joint.bodyA];
    def.base.bodyIdB = bodies[joint.bodyB];
    def.base.localFrameA = frame(localFrameA);
    def.base.localFrameB = frame(localFrameB);
    for (const [key, value] of Object.entries(fields)) {
      if (!(key in def)) throw new Error(`${type} has no ${key}`);
      def[key] = value;
    }
    B[`b2Create${kinds[type]}Joint`](world, def);
  }
  return {
    gravity: (g) => B.b2World_SetGravity(world, vec(g)),
    step: () => B.b2World_Step(world, 1 / 60, substeps),
    angle: (name) => B.b2Rot_GetAngle(B.b2Body_GetRotation(bodies[name])),
    position: (name) => { const p = B.b2Body_GetPosition(bodies[name]); return [p.x, p.y]; },
    mass: (name) => B.b2Body_GetMass(bodies[name]),
  };
}

function frame({p, angle}) {
  const transform = new B.b2Transform();
  transform.p = vec(p);
  transform.q = B.b2MakeRot(angle);
  return transform;
}
