// Parts of a picture as tasks, and a task that merges them: README.md.

const JOB_TYPE = {
  label: "Kaustik Render",
  description: "Render a picture in parts, and merge them.",
  settings: [
    {key: "scene", type: "string", required: true, subtype: "file_path", description: "Scene file"},
    {key: "folder", type: "string", required: true, subtype: "dir_path",
     description: "For lessons, checkpoints and the picture"},
    {key: "passes", type: "int32", default: 640, description: "Passes of all parts together"},
    {key: "samples", type: "int32", default: 2560, description: "Samples per pixel of all passes together"},
    {key: "parts", type: "int32", default: 64, description: "Parts, no more than passes"},
    {key: "integrator", type: "string", default: "auto", description: "auto, vcm, ppm or bdpt"},
    {key: "exe", type: "string", default: "kaustik", description: "The program"},
  ],
};

function kaustikTask(settings, name, args) {
  const task = author.Task(name, "misc");
  task.addCommand(author.Command("exec", {exe: settings.exe, args: args}));
  return task;
}

function lessonsOf(settings) {
  return `${settings.folder}/scene.kln`;
}

function partOf(settings, number) {
  return `${settings.folder}/part_${number}.kpt`;
}

function learnTask(settings) {
  return kaustikTask(settings, "learn", [
    "learn", settings.scene, "--integrator", settings.integrator, "-o", lessonsOf(settings), "-q",
  ]);
}

function renderTask(settings, number) {
  return kaustikTask(settings, `render-${number}`, [
    "render", settings.scene, "--integrator", settings.integrator, "--learned", lessonsOf(settings),
    "--passes", String(settings.passes), "--spp", String(settings.samples),
    "--part", `${number}/${settings.parts}`, "--checkpoint", partOf(settings, number), "--resume-if-there", "-q",
  ]);
}

function mergeTask(settings) {
  const args = ["merge"];
  for (let number = 1; number <= settings.parts; ++number) args.push(partOf(settings, number));
  return kaustikTask(settings, "merge", args.concat([
    "--force", "-o", `${settings.folder}/whole.kpt`, "-o", `${settings.folder}/picture.exr`,
  ]));
}

function compileJob(job) {
  const settings = job.settings;
  const learn = learnTask(settings), merge = mergeTask(settings);
  job.addTask(learn);
  for (let number = 1; number <= settings.parts; ++number) {
    const render = renderTask(settings, number);
    render.addDependency(learn);
    merge.addDependency(render);
    job.addTask(render);
  }
  job.addTask(merge);
}
