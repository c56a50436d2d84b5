// SPDX-License-Identifier: MIT OR Apache-2.0
// Names of the classes of detectors, as far as they are known.

/** The 80 classes of COCO, in the order of detectors. */
const COCO = ("person,bicycle,car,motorcycle,airplane,bus,train,truck,boat,traffic light,fire hydrant,stop sign,parking meter,bench,bird,cat,dog," +
  "horse,sheep,cow,elephant,bear,zebra,giraffe,backpack,umbrella,handbag,tie,suitcase,frisbee,skis,snowboard,sports ball,kite,baseball bat," +
  "baseball glove,skateboard,surfboard,tennis racket,bottle,wine glass,cup,fork,knife,spoon,bowl,banana,apple,sandwich,orange,broccoli,carrot," +
  "hot dog,pizza,donut,cake,chair,couch,potted plant,bed,dining table,toilet,tv,laptop,mouse,remote,keyboard,cell phone,microwave,oven,toaster," +
  "sink,refrigerator,book,clock,vase,scissors,teddy bear,hair drier,toothbrush").split(",");

/** Returns the name of a class of a detector with this format and number of classes. */
export function className({ head, classes }, number) {
  if (head === "yunet") return "face";
  return (classes === COCO.length && COCO[number]) || `class ${number}`;
}
