export { WebGLRenderer, Scene, PerspectiveCamera, Mesh, Group, BufferGeometry, BufferAttribute, MeshLambertMaterial, SphereGeometry, CylinderGeometry, LatheGeometry, TorusGeometry, Vector2, Vector3, Matrix4, DirectionalLight, HemisphereLight, Box3, DoubleSide } from 'three';
export { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
