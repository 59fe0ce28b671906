// SPDX-License-Identifier: GPL-3.0-or-later
// A job type of Flamenco 3: the frames of a .blend by Glimmer. Copy it into the folder `scripts` beside
// flamenco-manager and start that again.

const JOB_TYPE = {
    label: "Glimmer Frames",
    description: "Frames rendered by Glimmer. A failed frame fails its task and leaves no picture.",
    settings: [
        { key: "frames", type: "string", required: true,
          eval: "f'{C.scene.frame_start}-{C.scene.frame_end}'",
          description: "As 47, 1-30 or 3, 5-10, 47-327" },
        { key: "chunk_size", type: "int32", default: 1, visible: "submission",
          description: "Frames of a task. With 1 the task that fails is the frame that failed" },
        { key: "render_output_root", type: "string", subtype: "dir_path", required: true, visible: "submission",
          description: "Where a folder for the job is made" },
        { key: "render_output_path", type: "string", subtype: "file_path", editable: false,
          eval: "str(Path(abspath(settings.render_output_root), jobname, '######'))",
          description: "The pictures" },
        { key: "addon", type: "string", default: "glimmer", visible: "submission",
          description: "bl_ext.user_default.glimmer where Glimmer is installed as an extension" },
        { key: "blendfile", type: "string", required: true, visible: "web",
          description: "The file to render" },
        { key: "format", type: "string", required: true, visible: "web",
          eval: "C.scene.render.image_settings.file_format" },
    ],
};

const VIDEO_FORMATS = ["FFMPEG", "AVI_RAW", "AVI_JPEG"];

function compileJob(job) {
    const settings = job.settings;
    if (VIDEO_FORMATS.indexOf(settings.format) >= 0) {
        throw "Glimmer Frames renders pictures; " + settings.format + " is a film";
    }
    for (const chunk of frameChunker(settings.frames, settings.chunk_size)) {
        const task = author.Task("render-" + chunk, "blender");
        task.addCommand(author.Command("blender-render", {
            exe: "{blender}",
            exeArgs: "{blenderArgs}",
            argsBefore: ["--addons", settings.addon],
            blendfile: settings.blendfile,
            args: [
                "--engine", "GLIMMER",
                "--render-output", settings.render_output_path,
                "--render-format", settings.format,
                "--render-frame", chunk.split("-").join(".."), // as Blender has ranges
            ],
        }));
        job.addTask(task);
    }
}
