// Box2D 3 compiled for the web (box2d3-wasm): what `--to box2d` says under "3".
import Box2DFactory from 'box2d3-wasm';
import {createBody, jointKinds, player, setMass} from './box2d_c.mjs';
import {setFields} from './fields.mjs';

const B = await Box2DFactory();
const types = {static: B.b2BodyType.b2_staticBody, kinematic: B.b2BodyType.b2_kinematicBody,
               dynamic: B.b2BodyType.b2_dynamicBody};
const vec = ([x, y]) => new B.b2Vec2(x, y);

export function load(doc, choose) {
  const worldDef = B.b2DefaultWorldDef();
  worldDef.gravity = vec(doc.gravity);
  const world = B.b2CreateWorld(worldDef);
  const bodies = {};
  for (const b of doc.bodies) {
    const body = bodies[b.name] = createBody(B, world, b, types[b.type]);
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
    if (b.type === 'dynamic') setMass(B, body, b);
  }
  for (const joint of doc.joints) {
    const {type, localFrameA, localFrameB, ...fields} = choose(joint)['3'];
    const def = B[`b2Default${jointKinds[type]}JointDef`]();
    def.base.bodyIdA = bodies[joint.bodyA];
    def.base.bodyIdB = bodies[joint.bodyB];
    def.base.localFrameA = frame(localFrameA);
    def.base.localFrameB = frame(localFrameB);
    setFields(def, type, fields);
    B[`b2Create${jointKinds[type]}Joint`](world, def);
  }
  return player(B, world, bodies);
}

function frame({p, angle}) {
  const transform = new B.b2Transform();
  transform.p = vec(p);
  transform.q = B.b2MakeRot(angle);
  return transform;
}
